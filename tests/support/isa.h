#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "engine/base/error.h"
#include "models/simd/isa.h"

namespace poesy::test {

/// The instruction sets for which kernels are compiled on this platform.
#if defined(__x86_64__)
inline constexpr const char* kEveryIsa[] = {"plain", "avx2", "avx512"};
#elif defined(__aarch64__)
inline constexpr const char* kEveryIsa[] = {"plain", "neon"};
#else
inline constexpr const char* kEveryIsa[] = {"plain"};
#endif

/// Sets the environment variable POESY_ISA during the lifetime of the object.
class ForcedIsa {
 public:
  explicit ForcedIsa(const char* name) {
    if (const char* before = std::getenv("POESY_ISA")) before_ = before;
    setenv("POESY_ISA", name, 1);
  }
  ~ForcedIsa() {
    if (before_) {
      setenv("POESY_ISA", before_->c_str(), 1);
    } else {
      unsetenv("POESY_ISA");
    }
  }
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;

 private:
  std::optional<std::string> before_;
};

inline bool machine_has(const char* isa) {
  const ForcedIsa forced(isa);
  try {
    simd::selected_isa();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// A test that runs with each instruction set. It is skipped if the machine does not have the instruction set.
class WithIsa : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!machine_has(GetParam())) GTEST_SKIP() << "this machine has no " << GetParam();
    forced_.emplace(GetParam());
  }

 private:
  std::optional<ForcedIsa> forced_;
};

inline std::string isa_name(const testing::TestParamInfo<const char*>& info) { return info.param; }

}  // namespace poesy::test
