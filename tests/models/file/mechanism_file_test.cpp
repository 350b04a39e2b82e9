#include "models/file/mechanism_file.h"

#include <gtest/gtest.h>

#include "models/file/mobility.h"
#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

/// A wrong file: a line of a right one, what is put in its place, and how the message begins.
struct Wrong {
  const char* from;
  const char* to;
  const char* begin;
};

/// What reading says of the text, and of its mobility at home.
std::string problem_of(const std::string& text) {
  try {
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    const Mechanism made = mechanism(file, default_geometry(file));
    check_mobility(made, home_mobility(made));
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

std::string replaced(std::string text, const Wrong& wrong) {
  const std::size_t at = text.find(wrong.from);
  EXPECT_NE(at, std::string::npos) << wrong.from;
  return text.replace(at, std::string(wrong.from).size(), wrong.to);
}

void expect_refused(const std::string& name, const std::vector<Wrong>& list) {
  const std::string text = text_of(name);
  EXPECT_EQ(problem_of(text), "read");
  for (const Wrong& wrong : list) {
    const std::string problem = problem_of(replaced(text, wrong));
    EXPECT_TRUE(problem.starts_with(wrong.begin)) << wrong.to << "\n  " << problem;
    EXPECT_NE(problem.find("; "), std::string::npos) << "no remedy: " << problem;
  }
}

TEST(MechanismFile, RefusesWhatIsWrongInRps3) {
  expect_refused("rps3", {
#include "tests/models/file/wrong_rps3.inc"
                         });
}

TEST(MechanismFile, RefusesWhatIsWrongInOthers) {
  expect_refused("rrr3", {
#include "tests/models/file/wrong_rrr3.inc"
                         });
}

}  // namespace
}  // namespace poesy::file
