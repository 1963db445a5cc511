// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "cli/arguments.hpp"
#include "cli/commands.hpp"
#include "core/require.hpp"
#include "storage/store.hpp"

namespace {

using namespace opponens;

/// The one place where exceptions end; each kind has its exit code.
int run(const cli::Invocation& invocation) {
  try {
    return invocation.run(cli::Console(invocation.json, invocation.quiet));
  } catch (const cli::Interrupted& error) {
    cli::Console::warn(error.what());
    return cli::kInterrupted;
  } catch (const storage::StorageError& error) {
    cli::Console::warn(error.what());
    return cli::kStoreDamaged;
  } catch (const InputError& error) {
    cli::Console::warn(error.what());
    return cli::kInvalid;
  } catch (const std::invalid_argument& error) {
    cli::Console::warn(error.what());
    return cli::kInvalid;
  } catch (const std::exception& error) {
    cli::Console::warn(std::string("internal error: ") + error.what());
    return cli::kInvalid;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const cli::Invocation invocation = cli::parse_arguments(argc, argv);
  if (!invocation.run) {
    std::fputs(invocation.text.c_str(), invocation.exit_code == 0 ? stdout : stderr);
    return invocation.exit_code;
  }
  cli::catch_interrupts();
  return run(invocation);
}
