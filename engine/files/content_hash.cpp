#include "engine/files/content_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/files/sha256.h"

namespace poesy {
namespace {

/// SHA-256 of numbers and texts, as content_hash.h defines them.
class ContentSha256 {
 public:
  void bytes(const void* data, std::size_t count) { sha_.bytes({static_cast<const std::byte*>(data), count}); }

  void number(std::uint64_t value) {
    std::array<unsigned char, 8> little_endian{};
    for (unsigned char& byte : little_endian) {
      byte = static_cast<unsigned char>(value & 0xffU);
      value >>= 8U;
    }
    bytes(little_endian.data(), little_endian.size());
  }

  void text(std::string_view value) {
    number(value.size());
    bytes(value.data(), value.size());
  }

  std::string hex() { return poesy::hex(sha_.digest()); }

 private:
  Sha256 sha_;
};

bool is_bookkeeping(std::string_view attribute) {
  constexpr std::array<std::string_view, 4> kNames{"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"};
  return std::ranges::find(kNames, attribute) != kNames.end() || attribute.starts_with("_Netcdf4") ||
         attribute.starts_with("_nc3");
}

std::string_view type_name(h5::Value::Type type) {
  switch (type) {
    case h5::Value::Type::floating:
      return "float";
    case h5::Value::Type::signed_integer:
      return "int";
    case h5::Value::Type::unsigned_integer:
      return "uint";
    case h5::Value::Type::text:
      break;
  }
  return "text";
}

bool is_nan(std::uint64_t bits) { return std::isnan(std::bit_cast<double>(bits)); }

void make_nans_equal(h5::Value& value) {
  static_assert(std::endian::native == std::endian::little, "values arrive little-endian");
  constexpr std::uint64_t kNan = 0x7ff8000000000000U;
  if (value.type != h5::Value::Type::floating || value.width != sizeof(std::uint64_t)) return;
  for (std::size_t at = 0; at < value.numbers.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value.numbers[at], sizeof bits);
    if (is_nan(bits)) std::memcpy(&value.numbers[at], &kNan, sizeof kNan);
  }
}

class ContentHasher {
 public:
  explicit ContentHasher(const h5::File& file) : file_(&file) {}

  std::string operator()() {
    add_object("/");
    return sha_.hex();
  }

 private:
  void add_object(const std::string& path) {
    const bool group = file_->is_group(path);
    sha_.text(path);
    sha_.text(group ? "group" : "dataset");
    if (!group) add_value(file_->value(path));
    add_attributes(path);
    if (group) add_children(path);
  }

  void add_children(const std::string& path) {
    const std::string folder = path == "/" ? path : path + "/";
    for (const std::string& child : file_->children(path)) {
      if (folder + child != "/run") add_object(folder + child);
    }
  }

  void add_attributes(const std::string& path) {
    std::vector<std::string> names = file_->attributes(path);
    std::erase_if(names, [&](const std::string& name) {
      return is_bookkeeping(name) || (path == "/" && name == "content_sha256");
    });
    sha_.number(names.size());
    for (const std::string& name : names) {
      sha_.text(name);
      add_value(file_->attribute_value(path, name));
    }
  }

  void add_value(h5::Value value) {
    sha_.text(type_name(value.type));
    sha_.number(value.width);
    sha_.number(value.shape.size());
    for (const std::size_t length : value.shape) sha_.number(length);
    make_nans_equal(value);
    sha_.bytes(value.numbers.data(), value.numbers.size());
    for (const std::string& text : value.strings) sha_.text(text);
  }

  const h5::File* file_;
  ContentSha256 sha_;
};

}  // namespace

std::string content_sha256(const h5::File& file) { return ContentHasher(file)(); }

}  // namespace poesy
