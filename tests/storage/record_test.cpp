// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/record.hpp"

#include <cmath>
#include <set>

#include "storage/sha256.hpp"
#include "storage/text.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

// FIPS 180-4 examples (NIST, "SHA256.pdf").
TEST(Sha256, ExamplesOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  Sha256 pieces;
  pieces.update("abcdbcdecdefdefgefghfghighijhi");
  pieces.update("jkijkljklmklmnlmnomnopnopq");
  EXPECT_EQ(pieces.hex(), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Utf8, AcceptsWellFormedOnly) {
  for (const char* good :
       {"", "abc", "\xC3\xA9", "\xE2\x86\x92", "\xF0\x9F\xA4\x8F", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
  }
  for (const char* bad : {"\x80", "\xC3", "\xC0\xAF", "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80",
                          "\xF4\x90\x80\x80", "\xFF", "a\xE2\x86"}) {
    EXPECT_FALSE(is_utf8(bad)) << bad;
  }
}

TEST(ContentHash, EveryPartOfARecordCounts) {
  Record base = small_record(1);
  base.provenance.inputs = {"a", "b"};
  base.provenance.files["f"] = "h";
  std::vector<Record> variants(10, base);
  variants[0].kind = "path";
  variants[1].name += "x";
  variants[2].provenance.command = "analyze";
  variants[3].provenance.inputs = {"ab", ""};
  variants[4].provenance.files["f"] = "i";
  variants[5].provenance.parameters = "{}";
  variants[6].provenance.seed = 1;
  variants[7].provenance.program_version = "1";
  variants[8].fields["number"] = 1.0;  // a double, not an integer
  std::get<Eigen::VectorXd>(variants[9].fields["values"])[0] = -0.0;
  std::set<std::string> hashes{content_hash(base)};
  for (const auto& variant : variants) EXPECT_TRUE(hashes.insert(content_hash(variant)).second);
}

TEST(ContentHash, ShapeCounts) {
  Record row{"document", "", {}, {}};
  Record column = row;
  row.fields["m"] = Eigen::MatrixXd(Eigen::MatrixXd::Ones(1, 4));
  column.fields["m"] = Eigen::MatrixXd(Eigen::MatrixXd::Ones(4, 1));
  Record vector = row;
  vector.fields["m"] = Eigen::VectorXd(Eigen::VectorXd::Ones(4));
  EXPECT_NE(content_hash(row), content_hash(column));
  EXPECT_NE(content_hash(column), content_hash(vector));
}

TEST(CheckStorable, NamesTheFieldThatCannotBeStored) {
  const auto refusal = [](const std::string& field, Field value) {
    Record record = small_record(1);
    record.fields[field] = std::move(value);
    return message_of<std::invalid_argument>([&] { check_storable(record); });
  };
  Eigen::MatrixXd with_nan = Eigen::MatrixXd::Zero(2, 2);
  with_nan(1, 1) = std::nan("");
  EXPECT_TRUE(contains(refusal("q", with_nan), {"record 1", "'q'", "value 3 is NaN"}));
  EXPECT_TRUE(contains(refusal("weight", std::nan("")), {"'weight'", "NaN"}));
  EXPECT_TRUE(contains(refusal("text", std::string("a\0b", 3)), {"'text'", "zero byte"}));
  EXPECT_TRUE(contains(refusal("list", std::vector<std::string>{"ok", "\xFF"}), {"'list'", "not UTF-8"}));
  EXPECT_TRUE(contains(refusal("a/b", Eigen::VectorXd(3)), {"'a/b'", "'/'"}));
  EXPECT_TRUE(contains(refusal("", 1.0), {"needs a name"}));
  EXPECT_EQ(refusal("label.a/b", std::string("text")), "no exception");
  EXPECT_EQ(refusal("limit", std::numeric_limits<double>::infinity()), "no exception");
}

}  // namespace
}  // namespace opponens::storage::test
