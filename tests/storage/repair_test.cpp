// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/repair.hpp"

#include <unistd.h>

#include "storage/batch_file.hpp"
#include "storage/posix_file.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

/// A store with one file of two objects, of which the second is damaged.
struct Patient {
  TemporaryDirectory directory;
  fs::path path = directory / "store";
  std::string file;

  Patient() {
    Store(path, true).commit({small_record(1), small_record(2)});
    file = only_batch(path);
    std::string bytes = slurp(path / file);
    const std::size_t at = bytes.rfind("three");
    EXPECT_NE(at, std::string::npos);
    bytes[at] = 'T';
    spill(path / file, bytes);
  }
  std::vector<std::string> set_aside() const { return directory_entries(path / kDamagedFolder); }
};

void expect_repaired(const Patient& patient) {
  const RepairReport report = repair(patient.path, false);
  ASSERT_EQ(report.files.size(), 1U);
  EXPECT_EQ(report.files[0].saved.size(), 1U);
  EXPECT_EQ(report.files[0].lost.size(), 1U);
  EXPECT_EQ(patient.set_aside(), std::vector<std::string>{patient.file});
  EXPECT_TRUE(Store(patient.path, false).check().empty());
  for (const auto& name : directory_entries(patient.path)) EXPECT_FALSE(name.starts_with(".tmp-")) << name;
}

/// A killed process and the next one may have the same number, in a container for instance.
TEST(Repair, RunsAgainAfterARunThatWasKilledWithTheSameProcessId) {
  const Patient patient;
  fs::copy(patient.path, patient.directory / "copy");
  repair(patient.directory / "copy", false);
  const std::string replacement = only_batch(patient.directory / "copy");
  spill(patient.path / (".tmp-" + std::to_string(::getpid()) + "-" + replacement), "half of it");
  expect_repaired(patient);
}

TEST(Repair, SetsAFileAsideOnce) {
  const Patient patient;
  fs::create_directory(patient.path / kDamagedFolder);
  fs::create_hard_link(patient.path / patient.file, patient.path / kDamagedFolder / patient.file);
  expect_repaired(patient);
}

TEST(Repair, KeepsAnotherFileOfTheSameNameThatWasSetAside) {
  const Patient patient;
  spill(patient.path / kDamagedFolder / patient.file, "another");
  repair(patient.path, false);
  EXPECT_EQ(patient.set_aside(), (std::vector<std::string>{patient.file, patient.file + ".2"}));
  EXPECT_EQ(slurp(patient.path / kDamagedFolder / patient.file), "another");
}

TEST(Repair, WhatCannotBeReadIsToldAndLeft) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  const std::string id = Store(path, true).commit({small_record(1)}).front();
  const std::string name = batch_file_name(7, std::string(64, 'a'));
  fs::create_directory(path / name);
  const Store store(path, false);
  EXPECT_TRUE(same(store.read(id), small_record(1)));
  EXPECT_TRUE(contains(message_of<StorageError>([&] { store.list(); }), {name, "not a regular file"}));
  ASSERT_EQ(store.check().size(), 1U);
  for (const bool dry_run : {true, false}) {
    const RepairReport report = repair(path, dry_run);
    ASSERT_EQ(report.files.size(), 1U);
    EXPECT_TRUE(report.files[0].unreadable);
    EXPECT_TRUE(contains(report.files[0].reason, {name, "not a regular file"}));
    EXPECT_TRUE(fs::is_directory(path / name));
    EXPECT_FALSE(fs::exists(path / kDamagedFolder));
  }
  fs::remove(path / name);
  EXPECT_EQ(Store(path, false).list().size(), 1U);
}

TEST(Draft, TakesThePlaceOfWhatAKilledProcessLeft) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  spill(out.string() + ".tmp-" + std::to_string(::getpid()), "left");
  const Draft draft(out);
  write_new_file(draft.path(), std::as_bytes(std::span(std::string_view("new"))), Durable::no);
  draft.complete();
  EXPECT_EQ(slurp(out), "new");
}

}  // namespace
}  // namespace opponens::storage::test
