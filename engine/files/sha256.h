#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

// OpenSSL's state of a digest.
struct evp_md_ctx_st;

namespace poesy {

/// SHA-256 of bytes that come piece by piece.
class Sha256 {
 public:
  /// SHA-256 of some bytes.
  using Digest = std::array<std::byte, 32>;

  Sha256();
  /// Appends.
  void bytes(std::span<const std::byte> data);
  /// Nothing may be added afterwards.
  Digest digest();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// Lower-case hexadecimal.
std::string hex(std::span<const std::byte> bytes);

}  // namespace poesy
