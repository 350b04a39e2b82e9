#include "engine/app/command_line.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace poesy::app {
namespace {

TEST(WholeNumber, IsReadWithinItsBounds) {
  EXPECT_EQ(parse_whole_number("1", "--threads", 1, 1024), 1u);
  EXPECT_EQ(parse_whole_number("1024", "--threads", 1, 1024), 1024u);
}

TEST(WholeNumber, IsRefusedOtherwise) {
  for (const char* text : {"", "0", "1025", "-1", "+1", "1.5", "2 threads", "0x10", " 1", "99999999999999999999999"}) {
    try {
      parse_whole_number(text, "--threads", 1, 1024);
      ADD_FAILURE() << "'" << text << "' was taken";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--threads is '" + std::string(text) + "'; give a whole number from 1 to 1024");
    }
  }
}

}  // namespace
}  // namespace poesy::app
