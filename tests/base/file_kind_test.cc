#include "base/file_kind.h"

#include <gmock/gmock.h>

#include <string>

namespace hydro {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Tests that files are known by their beginnings, and TOML files by their sections, wherever those stand.
TEST(FileKindTest, Known) {
  const auto is = [](std::string_view text) { return FindFileKind(text); };
  EXPECT_EQ(is("\xed\xa1\xda\x01\x00"), FileKind::kLog);
  EXPECT_EQ(is("MATLAB 5.0 MAT-file, written by x"), FileKind::kMat);
  EXPECT_EQ(is("\x89HDF\r\n\x1a\n"), FileKind::kHdf5);
  EXPECT_EQ(is("\x89MCAP0\r\n"), FileKind::kMcap);
  EXPECT_EQ(is("PK\x03\x04"), FileKind::kSpreadsheet);
  EXPECT_EQ(is("<?xml version=\"1.0\"?>\n<svg>"), FileKind::kPicture);
  EXPECT_EQ(is("\n{\"a\": 1}"), FileKind::kJson);
  EXPECT_EQ(is("# a stack\n[model]\nfile = \"x\"\n"), FileKind::kStack);
  EXPECT_EQ(is("name = \"x\"\n[parameters]\n"), FileKind::kModel);
  EXPECT_EQ(is("\xef\xbb\xbf[columns]\n"), FileKind::kSidecar);
  EXPECT_EQ(is("[[draw]]\nkey = \"a\"\n"), FileKind::kStudy);
  EXPECT_EQ(is("[model]\n[[joint]]\n"), FileKind::kLimb);
  EXPECT_EQ(is("hydro-torture 1\n"), FileKind::kSchedule);
}

// Tests that tables, other texts and what is cut are not taken for anything.
TEST(FileKindTest, Unknown) {
  for (const std::string text : {"", "time_s,p1_psi\n0,1\n", "LabVIEW Measurement\t\n",
                                 "# see [model] above\n", "\xed\xa1", "a = 1\n"})
    EXPECT_EQ(FindFileKind(text), std::nullopt) << text;
  EXPECT_EQ(FindFileKind(std::string("\0\n[model]\n", 10)), std::nullopt);
}

// Tests the sentence: what was found, what is allowed, and who reads it; and the check that throws it.
TEST(FileKindTest, Said) {
  EXPECT_EQ(OtherKind(FileKind::kStudy, "s.toml", "a model"),
            "found a study, allowed a model; hydro-batch s.toml runs it");
  RequireKind(FileKind::kModel, "[parameters]\n", "m.toml", "a model");
  RequireKind(FileKind::kModel, "a = 1\n", "m.toml", "a model");
  try {
    RequireKind(FileKind::kModel, "[columns]\n", "run.toml", "a model");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("run.toml: found a sidecar"),
                                    HasSubstr("allowed a model; give hydro-diagnose")));
  }
}

}  // namespace
}  // namespace hydro
