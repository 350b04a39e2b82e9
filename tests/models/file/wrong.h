#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/file/metric_check.h"
#include "models/file/mobility.h"
#include "tests/models/file/files.h"

namespace poesy::file {

/// A wrong file: a part of a right one, what is put in its place, and the message.
struct Wrong {
  std::string from;
  std::string to;
  std::string message = {};
};

/// What reading says of the text, and of its mobility at home.
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

/// The text with that part replaced.
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
