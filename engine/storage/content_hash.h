#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "engine/storage/h5.h"

// The state of a digest in OpenSSL.
struct evp_md_ctx_st;

namespace poesy {

/// SHA-256 of bytes that are added piece by piece.
class Sha256 {
 public:
  using Digest = std::array<std::byte, 32>;  ///< A SHA-256 digest.

  Sha256();
  void bytes(std::span<const std::byte> data);  ///< Adds bytes to those that are hashed.
  Digest digest();                              ///< The digest of all added bytes. No bytes may be added afterwards.

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

Sha256::Digest sha256(std::span<const std::byte> bytes);  ///< The SHA-256 of these bytes.

std::string hex(std::span<const std::byte> bytes);  ///< The bytes in lower-case hexadecimal.

/// The SHA-256 (lower-case hexadecimal) of the content of a result file. The group `/run` and the attribute
/// `content_sha256`, in which the file states this hash, are not part of the content. The hash depends on names,
/// shapes, types and values, not on how HDF5 stores them.
///
/// What is hashed, in this order, so that any program can recompute it:
///
///     object(path)  = text(path) kind [value, for a dataset] number(attributes) { text(name) value }
///                     then, for a group, object(child) for each link
///     kind          = text("group") or text("dataset")
///     value         = text(type) number(width) number(rank) number(length of each axis) elements
///     type, width   = "float", "int" or "uint" with the bytes per number; "text" with 0
///     elements      = row-major; numbers as little-endian bytes of their width, every NaN of a 64-bit float as
///                     0x7ff8000000000000; each text as text()
///     text(s)       = number(bytes of s), the bytes (UTF-8)
///     number(n)     = 64 bits, unsigned, little-endian
///
/// The hash is that of object("/"). Links and attributes are in the order of the bytes of their names. An object with
/// several links is hashed once for each. Not hashed are the link `/run`, the root's attribute `content_sha256`, and in
/// all objects the attributes of dimension scales: CLASS, NAME, DIMENSION_LIST, REFERENCE_LIST, and names that begin
/// with _Netcdf4 or _nc3.
///
/// Throws h5::Error if a dataset or an attribute contains anything but numbers or text. Result files have only these.
std::string content_sha256(const h5::File& file);

}  // namespace poesy
