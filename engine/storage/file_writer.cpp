#include "engine/storage/file_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/plain_file.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr int kClosed = -1;

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// Throws InputError if there is something at the path that must not be replaced.
void check_present(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_regular_file(path, ignored)) {
    throw InputError({.file = path}, fs::is_directory(path, ignored) ? "is a folder" : "is not a plain file",
                     fmt::format("name a file for the {}", kind.name));
  }
  for (const std::string& input : inputs) {
    if (!fs::equivalent(path, input, ignored)) continue;
    throw InputError({.file = path}, fmt::format("is also an input, which the {} would replace", kind.name),
                     "name another file with -o");
  }
  if (kind.may_be_replaced(path)) return;
  throw InputError({.file = path}, fmt::format("exists and is not a {} of poesy, and it would be lost", kind.name),
                   "name another file with -o, or remove it");
}

/// Follows a chain of symbolic links to the path where it ends. Returns a path that is not a link unchanged.
std::string end_of_links(const std::string& path) {
  constexpr int kMostLinks = 40;  // the same limit as the system's
  fs::path at(path);
  std::error_code ignored;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, ignored)); ++links) {
    const fs::path to = fs::read_symlink(at, ignored);
    if (links == kMostLinks || to.empty()) {
      throw InputError({.file = path}, "is a symbolic link that leads nowhere, or in a circle", "name another file");
    }
    at = to.is_absolute() ? to : at.parent_path() / to;
  }
  return at.string();
}

constexpr std::string_view kTemporary = ".tmp.";
constexpr std::size_t kRandomBytes = 6;
constexpr std::string_view kDigits = "0123456789abcdef";

/// A random temporary name for a file; empty if `fill` fails, with the reason in errno.
std::string temporary_name(const std::string& path, FillRandomly fill) {
  std::array<std::byte, kRandomBytes> bytes{};
  if (!fill(bytes)) return {};
  std::string name = path + std::string(kTemporary);
  for (const std::byte byte : bytes) name += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  return name;
}

bool is_temporary_name(std::string_view name, std::string_view of_file) {
  if (!name.starts_with(of_file)) return false;
  name.remove_prefix(of_file.size());
  if (!name.starts_with(kTemporary)) return false;
  name.remove_prefix(kTemporary.size());
  return name.size() == 2 * kRandomBytes && name.find_first_not_of(kDigits) == std::string_view::npos;
}

/// The permission bits of the file `first` if it is a plain file, else those of `second`; none if neither is.
std::optional<mode_t> rights_of(const std::string& first, const std::string& second) {
  constexpr mode_t kAllRights = 0777;
  for (const std::string& file : {first, second}) {
    struct stat found {};
    if (::lstat(file.c_str(), &found) == 0 && S_ISREG(found.st_mode)) return found.st_mode & kAllRights;
  }
  return std::nullopt;
}

/// The first 64 KiB of a plain file; none if there is no plain file or it cannot be read.
std::optional<std::string> head_of(const std::string& path) {
  constexpr std::size_t kHead = 1 << 16;
  const PlainFile file(path);
  if (!file.is_open()) return std::nullopt;
  std::string head(kHead, '\0');
  const auto bytes = file.read(0, std::as_writable_bytes(std::span(head)));
  if (!bytes) return std::nullopt;
  head.resize(*bytes);
  return head;
}

/// Syncs the folder of a file, so that a rename survives a crash. Returns false with errno if that fails. It also
/// returns true if the folder may not be opened (EACCES), or if the file system cannot sync folders (EINVAL).
bool sync_folder(const std::string& path) {
  const int folder = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder == kClosed) return errno == EACCES;
  const bool synced = ::fsync(folder) == 0 || errno == EINVAL;
  const int error = errno;
  ::close(folder);
  errno = error;
  return synced;
}

}  // namespace

std::optional<std::string> content_of(const std::string& path) {
  if (!PlainFile(path).is_open()) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool has_mark(const std::string& path, std::string_view mark) {
  const auto head = head_of(path);
  return head && head->find(mark) != std::string::npos;
}

bool is_marked(const std::string& path, std::string_view mark) {
  const auto head = head_of(path);
  return head && (head->empty() || head->find(mark) != std::string::npos);
}

std::string check_output_path(const std::string& named, const OutputKind& kind, std::span<const std::string> inputs) {
  const std::string path = end_of_links(named);
  const fs::path folder = folder_of(path);
  check_present(path, kind, inputs);
  if (std::error_code ignored; !fs::is_directory(folder, ignored)) {
    throw InputError({.file = path}, "its folder " + folder.string() + " does not exist", "make it or choose another");
  }
  if (!fs::path(path).has_filename()) {
    throw InputError({.file = path}, "names no file", fmt::format("name a file for the {}", kind.name));
  }
  check_name_length(path + std::string(kind.longest_end));
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    const std::string reason = std::generic_category().message(errno);
    throw FileError(path, "cannot be written into its folder (" + reason + ")", "choose another folder");
  }
  return path;
}

void check_name_length(const std::string& path) {
  const std::size_t bytes = fs::path(path).filename().string().size() + kTemporary.size() + 2 * kRandomBytes;
  const long most = ::pathconf(folder_of(path).c_str(), _PC_NAME_MAX);
  if (most < 0 || bytes <= static_cast<std::size_t>(most))
    return;  // short enough, or the limit is unknown; the system will then report a name that is too long
  throw InputError({.file = path},
                   fmt::format("has too long a name: with what is added while it is written it takes {} bytes, and "
                               "names in its folder have {} at the most",
                               bytes, most),
                   fmt::format("give a name with -o that is shorter by {}", bytes - static_cast<std::size_t>(most)));
}

bool fill_randomly(std::span<std::byte> bytes) { return ::getentropy(bytes.data(), bytes.size()) == 0; }

bool stands(const std::string& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

void remove_left_over(const std::string& path) {
  std::error_code error;
  const std::string name = fs::path(path).filename().string();
  std::vector<fs::path> found;  // removed only after the loop, because a folder must not change while it is listed
  for (fs::directory_iterator at(folder_of(path), error), end; !error && at != end; at.increment(error)) {
    if (is_temporary_name(at->path().filename().string(), name)) found.push_back(at->path());
  }
  for (const fs::path& one : found) ::unlink(one.c_str());
}

FileWriter::FileWriter(std::string path, const std::string& like, FillRandomly fill)
    : path_(std::move(path)), temporary_(temporary_name(path_, fill)) {
  if (temporary_.empty()) fail("cannot be created", errno);
  struct stat there {};
  if (::stat(path_.c_str(), &there) == 0 && !S_ISREG(there.st_mode)) {
    throw FileError(path_, "is not a plain file and will not be replaced", "choose another name");
  }
  constexpr mode_t kReadableByAll = 0666;
  constexpr mode_t kPrivate = 0600;
  const std::optional<mode_t> rights = rights_of(like, path_);
  descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, rights ? kPrivate : kReadableByAll);
  if (descriptor_ == kClosed) fail("cannot be created", errno);
  if (rights) ::fchmod(descriptor_, *rights);
}

FileWriter::~FileWriter() {
  if (descriptor_ != kClosed) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void FileWriter::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void FileWriter::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void FileWriter::put(std::uint64_t at, std::span<const std::byte> bytes) noexcept {
  length_ = std::max<std::uint64_t>(length_, at + bytes.size());
  while (error_ == 0 && !bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error_ = errno;
      return;
    }
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

bool FileWriter::get(std::uint64_t at, std::span<std::byte> to) noexcept {
  while (error_ == 0 && !to.empty()) {
    const ssize_t read = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(at));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) error_ = errno;
    if (read <= 0) break;
    at += static_cast<std::uint64_t>(read);
    to = to.subspan(static_cast<std::size_t>(read));
  }
  std::ranges::fill(to, std::byte{0});
  return error_ == 0;
}

void FileWriter::end_at(std::uint64_t bytes) noexcept {
  length_ = bytes;
  while (error_ == 0 && ::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) {
    if (errno != EINTR) error_ = errno;
  }
}

void FileWriter::check() const {
  if (error_ != 0) fail("cannot be written", error_);
}

void FileWriter::sync() {
  check();
  if (::fsync(descriptor_) != 0) fail("cannot be written", errno);
  if (::close(std::exchange(descriptor_, kClosed)) != 0) fail("cannot be written", errno);
}

void FileWriter::commit() {
  if (descriptor_ != kClosed) sync();
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be put in place", errno);
  temporary_.clear();
  if (!sync_folder(path_)) fail("is in place, but its folder cannot be synced", errno);
}

std::uint64_t FileWriter::expected_size() const { return expected_ ? expected_() : length_; }

/// The text "; needs 1000 bytes, 200 are free", as far as the numbers are known. The blocks of the unfinished file
/// count as free, because that file will be removed.
std::string FileWriter::missing_space() const {
  const std::uint64_t size = expected_size();
  std::string text = size == 0 ? "" : "; needs " + std::to_string(size) + " bytes";
  struct statvfs disk {};
  struct stat file {};
  constexpr std::uintmax_t kStatBlock = 512;  // the unit of st_blocks
  if (::fstatvfs(descriptor_, &disk) == 0 && ::fstat(descriptor_, &file) == 0) {
    const std::uintmax_t taken = static_cast<std::uintmax_t>(file.st_blocks) * kStatBlock;
    const std::uintmax_t free = std::uintmax_t{disk.f_bavail} * disk.f_frsize + taken;
    text += (text.empty() ? "; " : ", ") + std::to_string(free) + " are free";
  }
  return text;
}

std::string FileWriter::remedy(int error) const {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "make room or choose another folder";
    case EFBIG: {
      const std::uint64_t size = expected_size();
      return "raise the limit on file sizes" + (size == 0 ? "" : " to " + std::to_string(size) + " bytes") +
             " or choose another folder";
    }
    case ENAMETOOLONG:
      return "give it a shorter name, or choose a folder with a shorter path";
    case EMFILE:
      return "raise the limit on open files (ulimit -n)";
    case ENFILE:
      return "end other programs, which have too many files open";
    case ENOENT:
    case ENOTDIR:
      return "make the folder or choose another one";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    default:
      return "choose another folder, or repair the disk";
  }
}

void FileWriter::fail(std::string_view action, int error) const {
  std::string reason = std::generic_category().message(error);
  if (error == ENOSPC && descriptor_ != kClosed) reason += missing_space();
  throw FileError(path_, std::string(action) + " (" + reason + ")", remedy(error));
}

void write_text(const std::string& path, std::string_view text) {
  FileWriter file(path);
  file.expect(text.size());
  file.write(text);
  file.commit();
}

void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file) {
  const auto fail = [&](const std::error_code& error) {
    throw FileError(second, "cannot be put in place (" + error.message() + ")", "check the folder");
  };
  const std::string temporary = temporary_name(second, fill_randomly);
  std::error_code error;
  if (!temporary.empty() && link_file(path.c_str(), temporary.c_str()) == 0) {
    fs::rename(temporary, second, error);
    ::unlink(temporary.c_str());  // needed if both names already were one file, because rename() then does nothing
    if (error) fail(error);
    return;
  }
  const PlainFile file(path);
  if (!file.is_open()) fail(std::error_code(file.error(), std::generic_category()));
  FileWriter copy(second, path);
  if (!file.read_parts([&](std::span<const std::byte> part) { copy.write(part); })) {
    fail(std::error_code(errno, std::generic_category()));
  }
  copy.commit();
}

void put_at_second_name(const std::string& path, const std::string& second) {
  put_at_second_name(path, second, ::link);
}

}  // namespace poesy
