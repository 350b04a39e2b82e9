#include "models/simd/isa.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/isa.h"

namespace poesy::simd {
namespace {

TEST(SelectedIsa, IsTheOneAskedFor) {
  const test::ForcedIsa forced("plain");
  EXPECT_EQ(selected_isa(), Isa::plain);
}

TEST(SelectedIsa, IsTheBestOneWhenNoneIsAskedFor) {
  const test::ForcedIsa nothing("");
  const Isa best = test::machine_has("avx512") ? Isa::avx512
                   : test::machine_has("avx2") ? Isa::avx2
                   : test::machine_has("neon") ? Isa::neon
                                               : Isa::plain;
  EXPECT_EQ(selected_isa(), best);
}

TEST(SelectedIsa, RefusesWhatIsNotThere) {
  const test::ForcedIsa forced("avx1024");
  try {
    selected_isa();
    FAIL() << "accepted avx1024";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("POESY_ISA"), std::string::npos) << message;
    EXPECT_NE(message.find("avx1024"), std::string::npos) << message;
    EXPECT_NE(message.find("plain"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace poesy::simd
