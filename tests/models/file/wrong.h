#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/file/metric_check.h"
#include "models/file/mobility.h"
#include "tests/models/file/files.h"

namespace poesy::file {

/// A wrong file: in a valid file, `from` is replaced by `to`; it must be refused with `message`.
struct Wrong {
  std::string from;
  std::string to;
  std::string message = {};
};

/// The message with which the text is refused by reading or by the checks of mobility and metric. "read" if it is
/// accepted.
inline std::string problem_of(const std::string& text) {
  try {
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    const Mechanism made = mechanism(file, default_geometry(file));
    check_mobility(made, home_mobility(made));
    check_metric(file, made);
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

/// The text with `from` replaced by `to`.
inline std::string replaced(std::string text, const Wrong& wrong) {
  const std::size_t at = text.find(wrong.from);
  EXPECT_NE(at, std::string::npos) << wrong.from;
  return text.replace(at, std::string(wrong.from).size(), wrong.to);
}

/// Expects each of these files to be refused with its message and a remedy.
inline void expect_refused(const std::string& name, const std::vector<Wrong>& list) {
  const std::string text = text_of(name);
  EXPECT_EQ(problem_of(text), "read");
  for (const Wrong& wrong : list) {
    const std::string problem = problem_of(replaced(text, wrong));
    EXPECT_EQ(problem, wrong.message) << wrong.to;
    EXPECT_NE(problem.find("; "), std::string::npos) << "no remedy: " << problem;
  }
}

}  // namespace poesy::file
