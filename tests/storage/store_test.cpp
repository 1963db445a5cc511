// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/store.hpp"

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/hdf5_wrappers.hpp"
#include "storage/single_file.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

TEST(Store, RandomRecordsComeBackBitForBit) {
  const TemporaryDirectory directory;
  Rng rng = stream(1, "records");
  std::vector<Record> records;
  for (int i = 0; i < 200; ++i) records.push_back(any_record(rng));
  Store store(directory / "store", true);
  const std::vector<std::string> ids = store.commit(records);
  const Store again(directory / "store", false);
  for (std::size_t i = 0; i < records.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(ids[i], content_hash(records[i]));
    EXPECT_TRUE(same(again.read(ids[i]), records[i]));
  }
  EXPECT_TRUE(again.check().empty());
}

TEST(Store, LargeArraysComeBack) {
  const TemporaryDirectory directory;
  Record record{"document", "large", {}, {}};
  Eigen::MatrixXd tall = Eigen::MatrixXd::Zero(300000, 3);
  tall.col(1).setLinSpaced(0.0, 1.0);
  record.fields["tall"] = tall;
  record.fields["wide"] = Eigen::MatrixXd(Eigen::MatrixXd::Random(2, 200000));
  record.fields["long"] = Eigen::VectorXd(Eigen::VectorXd::Random(1000));
  Store store(directory / "store", true);
  EXPECT_TRUE(same(store.read(store.commit({record}).front()), record));
}

TEST(Store, ListsInOrderOfCommitAndByKind) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  Record path = small_record(5);
  path.kind = "path";
  path.provenance.inputs = {"x", "y"};
  store.commit({small_record(9), small_record(1)});
  store.commit({path});
  store.commit({small_record(4)});
  for (const Store* view : {&store, new Store(directory / "store", false)}) {
    std::vector<std::string> names;
    for (const auto& entry : view->list()) names.push_back(entry.name);
    EXPECT_EQ(names, (std::vector<std::string>{"record 9", "record 1", "record 5", "record 4"}));
    ASSERT_EQ(view->list("path").size(), 1U);
    EXPECT_EQ(view->list("path").front().inputs, path.provenance.inputs);
    EXPECT_EQ(view->list("path").front().id, content_hash(path));
    if (view != &store) delete view;
  }
}

TEST(Store, WhatIsPresentIsNotWrittenAgain) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  const auto first = store.commit({small_record(1), small_record(2), small_record(1)});
  EXPECT_EQ(first[0], first[2]);
  const auto before = contents(directory / "store");
  EXPECT_EQ(store.commit({small_record(2), small_record(1)}), (std::vector<std::string>{first[1], first[0]}));
  EXPECT_TRUE(store.commit({}).empty());
  EXPECT_EQ(contents(directory / "store"), before);
  EXPECT_EQ(store.list().size(), 2U);
}

std::vector<std::string> names_as_produced(const Store& store) {
  std::vector<std::string> names;
  for (const auto& entry : store.list_as_produced("document")) names.push_back(entry.name.substr(7));
  return names;
}

TEST(Store, WhatIsMadeAgainIsTheNewestAgain) {
  const TemporaryDirectory directory;
  using Names = std::vector<std::string>;
  Store store(directory / "store", true);
  store.commit({small_record(1), small_record(2)});
  store.commit({small_record(3)});
  EXPECT_EQ(names_as_produced(store), (Names{"1", "2", "3"}));
  store.commit({small_record(1)});
  store.log_run("{\"command\": \"another\"}");
  EXPECT_EQ(names_as_produced(store), (Names{"2", "3", "1"}));
  store.commit({small_record(2), small_record(4)});  // one is there already, one is new
  EXPECT_EQ(names_as_produced(store), (Names{"3", "1", "2", "4"}));
  store.commit({small_record(5)});
  store.commit({small_record(3), small_record(1)});
  EXPECT_EQ(names_as_produced(Store(directory / "store", false)), (Names{"2", "4", "5", "3", "1"}));

  // A log that is cut off loses what its last line told; without a log the order of the files is left.
  const fs::path log = directory / "store" / "runs.jsonl";
  fs::resize_file(log, fs::file_size(log) - 10);
  EXPECT_EQ(names_as_produced(store), (Names{"3", "1", "2", "4", "5"}));
  fs::remove(log);
  EXPECT_EQ(names_as_produced(store), (Names{"1", "2", "3", "4", "5"}));
}

TEST(Store, ALogLineThatIsCutOffDoesNotSwallowTheNext) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  store.commit({small_record(1), small_record(2), small_record(3)});
  store.commit({small_record(1)});
  const fs::path log = directory / "store" / "runs.jsonl";
  fs::resize_file(log, fs::file_size(log) / 2);
  EXPECT_EQ(names_as_produced(store), (std::vector<std::string>{"1", "2", "3"}));
  store.commit({small_record(2)});
  EXPECT_EQ(names_as_produced(store), (std::vector<std::string>{"1", "3", "2"}));
}

TEST(Store, ALogThatSaysOtherThingsIsNoHindrance) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  const auto ids = store.commit({small_record(1), small_record(2)});
  for (const std::string line :
       {"[]", "{\"produced\": 5, \"after\": {}}", "{\"produced\": [\"gone\"], \"after\": \"gone\"}"}) {
    store.log_run(line);
  }
  store.log_run("{\"produced\": [\"gone\", \"" + ids[0] + "\"], \"after\": \"" + ids[1] + "\"}");
  EXPECT_EQ(names_as_produced(store), (std::vector<std::string>{"2", "1"}));
}

TEST(Store, LargeCommitsAreSplitIntoFilesOfBoundedSize) {
  const TemporaryDirectory directory;
  Rng rng = stream(2, "payload");
  std::vector<Record> records;
  for (int i = 0; i < 5; ++i) {
    Record record = small_record(i);
    Eigen::MatrixXd payload(700000, 1);  // 5.6 MB: two fit under 16 MB, three do not
    for (auto& value : payload.reshaped()) value = rng.uniform();
    record.fields["payload"] = std::move(payload);
    records.push_back(std::move(record));
  }
  Store store(directory / "store", true);
  const auto ids = store.commit(records);
  std::map<std::string, int> per_file;
  for (const auto& entry : store.list()) ++per_file[entry.file];
  std::vector<int> counts;
  for (const auto& [file, count] : per_file) counts.push_back(count);
  EXPECT_EQ(counts, (std::vector<int>{2, 2, 1}));
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_TRUE(same(store.read(ids[i]), records[i]));
}

TEST(Store, ReadsByUnambiguousPrefix) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  std::vector<Record> records;
  for (int i = 0; i < 40; ++i) records.push_back(small_record(i));  // 16 first digits: some are shared
  const auto ids = store.commit(records);
  EXPECT_TRUE(same(store.read(ids[7].substr(0, 16)), records[7]));
  EXPECT_TRUE(contains(message_of<InputError>([&] { store.read("xyz"); }), {"no object", "xyz"}));
  int ambiguous = 0;
  for (const char digit : std::string("0123456789abcdef")) {
    const std::string text = message_of<InputError>([&] { store.read(std::string(1, digit)); });
    ambiguous += text.find("ambiguous") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(ambiguous, 0);
  EXPECT_THROW(store.read(""), std::invalid_argument);
}

TEST(Store, RefusesDirectoriesThatAreNone) {
  const TemporaryDirectory directory;
  const auto refusal = [](const fs::path& path, bool create) {
    return message_of<InputError>([&] { Store(path, create); });
  };
  EXPECT_TRUE(contains(refusal(directory / "absent", false), {"absent", "No such file or directory"}));
  spill(directory / "file", "text");
  EXPECT_TRUE(contains(refusal(directory / "file", false), {"file", "not a directory"}));
  EXPECT_TRUE(contains(refusal(directory / "file", true), {"file", "ot a directory"}));
  fs::create_directory(directory / "empty");
  EXPECT_TRUE(contains(refusal(directory / "empty", false), {"empty", "not a store"}));
  { const Store store(directory / "empty", true); }
  EXPECT_TRUE(Store(directory / "empty", false).list().empty());
}

TEST(Store, RefusedRecordLeavesTheStoreAsItWas) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  store.commit({small_record(1)});
  const auto before = contents(directory / "store");
  Record bad = small_record(2);
  bad.fields["q"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(store.commit({small_record(3), bad}), std::invalid_argument);
  EXPECT_EQ(contents(directory / "store"), before);
}

TEST(Store, IndexIsRebuiltWhenAbsentDamagedOrOld) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  Store store(path, true);
  store.commit({small_record(1)});
  const std::string old = slurp(path / "index.bin");
  store.commit({small_record(2), small_record(3)});
  const std::string index = slurp(path / "index.bin");
  std::string renamed = index;
  renamed.replace(renamed.find("record 2"), 8, "record 7");  // valid JSON with another name
  const std::string emptied = "{\"schema_version\": 1, \"entries\": []}";
  for (const std::string& text : {old, std::string(), index.substr(0, index.size() / 2), renamed, emptied,
                                  std::string("[]"), std::string("\xFF\x00", 2)}) {
    spill(path / "index.bin", text);
    const Store again(path, false);
    ASSERT_EQ(again.list().size(), 3U) << text;
    EXPECT_EQ(again.list()[1].name, "record 2");
    EXPECT_EQ(slurp(path / "index.bin"), index);
  }
  fs::remove(path / "index.bin");
  EXPECT_EQ(Store(path, false).list().size(), 3U);
  EXPECT_EQ(slurp(path / "index.bin"), index);
}

TEST(Store, NewerSchemaIsRefusedWithASentence) {
  const auto write_file = [](std::int64_t file_version, std::int64_t object_version, const fs::path& store) {
    const hdf5::Handle file = hdf5::create_in_memory();
    const hdf5::Handle root = hdf5::open_group(file, "/");
    hdf5::write_attribute(root, "format", std::string("opponens batch"));
    hdf5::write_attribute(root, "schema_version", file_version);
    const hdf5::Handle objects = hdf5::create_group(root, "objects");
    const hdf5::Handle object = hdf5::create_group(objects, "000000");
    hdf5::write_attribute(object, "schema_version", object_version);
    const auto bytes = hdf5::image(file);
    spill(store / batch_file_name(0, bytes), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  const TemporaryDirectory directory;
  write_file(kSchemaVersion + 1, 1, directory / "file");
  write_file(1, kSchemaVersion + 1, directory / "object");
  for (const char* name : {"file", "object"}) {
    EXPECT_TRUE(contains(message_of<StorageError>([&] { Store(directory / name, false); }),
                         {name, "schema version 2", "up to 1", "newer opponens"}));
  }
}

TEST(Store, NewerContentsAreRefusedWithASentence) {
  const TemporaryDirectory directory;
  const Step ignored = [](std::size_t, std::size_t) {};
  Store store(directory / "store", true);
  store.commit({small_record(1)});
  const fs::path single = directory / "single.h5";
  export_single_file(store, store.list(), single, ignored);
  std::string bytes = slurp(single);
  bytes.back() = '2';
  spill(single, bytes);
  EXPECT_TRUE(contains(message_of<NewerSchemaError>([&] { import_single_file(single, store, ignored); }),
                       {"single.h5", "schema version 2", "newer opponens"}));
  const std::string name = batch_file_name(0, std::as_bytes(std::span(bytes)));
  spill(directory / "newer" / name, bytes);
  EXPECT_TRUE(contains(message_of<NewerSchemaError>([&] { Store(directory / "newer", false); }), {name, "version 2"}));
  spill(directory / "damaged" / name, bytes.replace(0, 1, "?"));  // its last byte cannot be believed either
  EXPECT_TRUE(contains(message_of<StorageError>([&] { Store(directory / "damaged", false).list(); }),
                       {name, "do not match the hash"}));
}

TEST(Store, BatchNumbersEndBeforeTheNextOneWouldNotExist) {
  const std::string rest = "-" + std::string(32, 'a') + ".h5";
  EXPECT_EQ(batch_number("4611686018427387903" + rest), 4611686018427387903);
  EXPECT_EQ(batch_number("4611686018427387904" + rest), -1);
}

TEST(Store, RunLogIsBesideTheObjects) {
  const TemporaryDirectory directory;
  const Store store(directory / "store", true);
  store.log_run("{\"command\": \"demo\"}");
  store.log_run("{}");
  EXPECT_EQ(slurp(directory / "store" / "runs.jsonl"), "{\"command\": \"demo\"}\n{}\n");
  EXPECT_THROW(store.log_run("a\nb"), std::invalid_argument);
  EXPECT_TRUE(store.check().empty());
}

}  // namespace
}  // namespace opponens::storage::test
