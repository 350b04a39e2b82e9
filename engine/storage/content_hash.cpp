#include "engine/storage/content_hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

namespace poesy {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are hashed as they are in memory");

void check(int ok) {
  if (ok != 1) throw std::runtime_error("OpenSSL cannot compute a SHA-256 hash");
}

/// Names of the types, in the order of h5::Value::Type.
constexpr std::string_view kTypeNames[] = {"float", "int", "uint", "text"};

bool is_bookkeeping(std::string_view attribute) {
  constexpr std::string_view kNames[] = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"};
  return std::ranges::find(kNames, attribute) != std::end(kNames) || attribute.starts_with("_Netcdf4") ||
         attribute.starts_with("_nc3");
}

/// Gives all NaNs in `numbers` the same bits, if the numbers are doubles. head: type and width of the numbers.
void make_nans_equal(const h5::Value& head, std::span<std::byte> numbers) {
  constexpr std::uint64_t kNan = 0x7ff8000000000000U;
  if (head.type != h5::Value::Type::floating || head.width != sizeof(double)) return;
  for (std::size_t at = 0; at < numbers.size(); at += sizeof(double)) {
    double number = 0.0;
    std::memcpy(&number, &numbers[at], sizeof number);
    if (std::isnan(number)) std::memcpy(&numbers[at], &kNan, sizeof kNan);
  }
}

/// Computes the hash of a file as content_hash.h describes it.
class ContentHasher {
 public:
  explicit ContentHasher(const h5::File& file) : file_(file) {}

  std::string operator()() {
    add_object("/");
    return hex(sha_.digest());
  }

 private:
  void number(std::uint64_t value) { sha_.bytes(std::as_bytes(std::span(&value, 1))); }

  void text(std::string_view value) {
    number(value.size());
    sha_.bytes(std::as_bytes(std::span(value)));
  }

  void add_object(const std::string& path) {
    const bool group = file_.is_group(path);
    text(path);
    text(group ? "group" : "dataset");
    if (!group) add_dataset(path);
    add_attributes(path);
    if (!group) return;
    const std::string folder = path == "/" ? path : path + "/";
    for (const std::string& child : file_.children(path)) {
      if (folder + child != "/run") add_object(folder + child);
    }
  }

  void add_attributes(const std::string& path) {
    std::vector<std::string> names = file_.attributes(path);
    std::erase_if(names, [&](const std::string& name) {
      return is_bookkeeping(name) || (path == "/" && name == "content_sha256");
    });
    number(names.size());
    for (const std::string& name : names) {
      text(name);
      add_value(file_.attribute_value(path, name));
    }
  }

  void add_dataset(const std::string& path) {
    const h5::Value head = file_.head(path);
    if (head.type == h5::Value::Type::text) return add_value(file_.value(path));
    add_head(head);
    file_.read_slices(path, [&](std::span<std::byte> slice) { add_numbers(head, slice); });
  }

  void add_value(h5::Value value) {
    add_head(value);
    add_numbers(value, value.numbers);
    for (const std::string& one : value.strings) text(one);
  }

  void add_head(const h5::Value& value) {
    text(kTypeNames[static_cast<std::size_t>(value.type)]);
    number(value.width);
    number(value.shape.size());
    for (const std::size_t length : value.shape) number(length);
  }

  void add_numbers(const h5::Value& head, std::span<std::byte> numbers) {
    make_nans_equal(head, numbers);
    sha_.bytes(numbers);
  }

  const h5::File& file_;
  Sha256 sha_;
};

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  if (context_ == nullptr) throw std::bad_alloc();
  check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void Sha256::bytes(std::span<const std::byte> data) {
  check(EVP_DigestUpdate(context_.get(), data.data(), data.size()));
}

Sha256::Digest Sha256::digest() {
  Digest digest{};
  check(EVP_DigestFinal_ex(context_.get(), reinterpret_cast<unsigned char*>(digest.data()), nullptr));
  return digest;
}

Sha256::Digest sha256(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.bytes(bytes);
  return sha.digest();
}

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  return text;
}

std::string content_sha256(const h5::File& file) { return ContentHasher(file)(); }

}  // namespace poesy
