// cmake/harden_decoders.sh completes the decoders that lcm-gen has written, or reports a failure.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A decoder as lcm-gen writes it. Its type has a member of each kind that needs a check.
class HardenDecodersTest : public testing::Test {
 protected:
  HardenDecodersTest() {
    std::ofstream(folder_.path() / "sample_t.lcm")
        << "package probe;\nstruct sample_t {\n  int32_t num_texts;\n  int32_t num_values;\n"
           "  string name;\n  string texts[num_texts];\n  double values[num_values];\n}\n";
    const Outcome made =
        RunCommand({"lcm-gen", "-x", "--cpp-std", "c++11", "--cpp-hpath", folder_.path().string(),
                    (folder_.path() / "sample_t.lcm").string()});
    EXPECT_EQ(made.code, 0) << made.err;
    header_ = folder_.path() / "probe" / "sample_t.hpp";
  }

  std::string Text() const {
    std::ifstream in(header_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Replaces a text in the decoder, as if another lcm-gen had written it.
  void Replace(const std::string& what, const std::string& by) const {
    std::string text = Text();
    const std::size_t begin = text.rfind(what);
    ASSERT_NE(begin, std::string::npos) << what;
    std::ofstream(header_) << text.replace(begin, what.size(), by);
  }
  Outcome Harden() const {
    return RunCommand(
        {(SourceDirectory() / "cmake" / "harden_decoders.sh").string(), header_.string()});
  }

  ScratchFolder folder_;
  std::filesystem::path header_;
};

TEST_F(HardenDecodersTest, ChecksEachLengthAndClearsEachArray) {
  const Outcome outcome = Harden();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = Text();
  EXPECT_THAT(text, HasSubstr("if (this->num_texts < 0 || this->num_texts > maxlen) return -1;"));
  EXPECT_THAT(text, HasSubstr("if (this->num_values < 0 || this->num_values > maxlen) return -1;"));
  EXPECT_THAT(text, HasSubstr("if(__name_len__ < 1 || __name_len__ > maxlen - pos) return -1;"));
  EXPECT_THAT(text, HasSubstr("if(__elem_len < 1 || __elem_len > maxlen - pos) return -1;"));
  EXPECT_THAT(text, HasSubstr("this->values.clear();\n    if(this->num_values) {"));
  EXPECT_THAT(text, Not(HasSubstr("if(__name_len__ > maxlen - pos) return -1;")));
}

TEST_F(HardenDecodersTest, RefusesAnArrayThatItDoesNotFind) {
  Replace("this->texts.resize(this->num_texts);", "this->texts.resize( this->num_texts );");
  const Outcome outcome = Harden();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("sample_t.hpp: an array without a check of its length"));
}

TEST_F(HardenDecodersTest, RefusesAStringThatItDoesNotFind) {
  Replace("if(__name_len__ > maxlen - pos) return -1;",
          "if(maxlen - pos < __name_len__) return -1;");
  const Outcome outcome = Harden();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("sample_t.hpp: a string without a check of its end"));
}

TEST_F(HardenDecodersTest, RefusesAnArrayOfNumbersThatKeepsItsElements) {
  Replace("if(this->num_values) {\n        this->values.resize",
          "if(0 != this->num_values) {\n        this->values.resize");
  const Outcome outcome = Harden();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("sample_t.hpp: an array that keeps its elements"));
}

}  // namespace
}  // namespace fogline::test
