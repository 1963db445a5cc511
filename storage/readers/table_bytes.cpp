// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <string_view>

#include "core/require.hpp"
#include "storage/readers/table.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

constexpr std::size_t kHash = 64;  // hex digits at the end

void put(std::string& bytes, std::uint64_t value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

void put(std::string& bytes, const std::string& text) {
  put(bytes, std::uint64_t{text.size()});
  bytes += text;
}

/// Takes values off the front of bytes; every length is checked against what is left.
class Unpacker {
 public:
  Unpacker(std::string_view bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

  std::uint64_t count() {
    std::uint64_t value = 0;
    const std::string_view raw = take(sizeof value);
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  std::string text() {
    const std::string_view raw = take(count());
    expect(is_utf8(raw), "a text is not UTF-8");
    return std::string(raw);
  }
  std::vector<double> numbers() {
    const std::uint64_t size = count();
    expect(size <= bytes_.size() / sizeof(double), "fewer numbers than announced");
    std::vector<double> values(size);
    const std::string_view raw = take(size * sizeof(double));
    if (size > 0) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  void expect(bool condition, const char* complaint) const {
    if (!condition) throw InputError(file_.string() + ": the child process that read it sent nonsense: " + complaint);
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    expect(size <= bytes_.size(), "fewer bytes than announced");
    const std::string_view front = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return front;
  }

  std::string_view bytes_;
  const std::filesystem::path& file_;
};

}  // namespace

std::string to_bytes(const std::vector<Table>& tables) {
  std::string bytes;
  put(bytes, std::uint64_t{tables.size()});
  for (const auto& table : tables) {
    put(bytes, table.part);
    put(bytes, std::uint64_t{table.facts.size()});
    for (const auto& [name, value] : table.facts) {
      put(bytes, name);
      put(bytes, value);
    }
    put(bytes, std::uint64_t{table.width});
    put(bytes, std::uint64_t{table.values.size()});
    bytes.append(reinterpret_cast<const char*>(table.values.data()), table.values.size() * sizeof(double));
  }
  return bytes + sha256(bytes);
}

std::vector<Table> from_bytes(const std::string& bytes, const std::filesystem::path& file,
                              const SourceDescription& source) {
  const std::string_view all(bytes);
  const std::size_t content = all.size() < kHash ? 0 : all.size() - kHash;
  Unpacker unpack(all.substr(0, content), file);
  unpack.expect(all.size() > kHash && sha256(all.substr(0, content)) == all.substr(content), "the hash differs");
  const std::size_t width = time_width(source) + source.channels.size();
  std::vector<Table> tables;
  for (std::uint64_t left = unpack.count(); left > 0; --left) {
    Table table;
    table.part = unpack.text();
    for (std::uint64_t facts = unpack.count(); facts > 0; --facts) {
      const std::string name = unpack.text();
      table.facts[name] = unpack.text();
    }
    table.width = unpack.count();
    table.values = unpack.numbers();
    unpack.expect(table.width == width && table.values.size() % width == 0, "rows of another width");
    tables.push_back(std::move(table));
  }
  unpack.expect(unpack.empty(), "more bytes than announced");
  return tables;
}

}  // namespace opponens::storage
