#include "engine/files/checkpoint_files.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <variant>

#include "engine/base/error.h"
#include "engine/files/file_writer.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// A checkpoint, or why there is none to be had.
std::variant<Checkpoint, std::string> read(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return is_there(path) ? "is not a plain file" : "does not exist";
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  Bytes bytes(file ? static_cast<std::size_t>(fs::file_size(path, ignored)) : 0);
  if (!file || !file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    return "cannot be read (" + std::generic_category().message(errno) + ")";
  }
  try {
    return decode_checkpoint(bytes);
  } catch (const BytesError& error) {
    return error.what();
  }
}

}  // namespace

CheckpointFiles::CheckpointFiles(const std::string& result_path)
    : newer_(result_path + ".part"), older_(newer_ + ".1"), temporary_(newer_ + ".tmp") {}

bool CheckpointFiles::exist() const { return is_there(newer_) || is_there(older_); }

std::optional<FoundCheckpoint> CheckpointFiles::find() {
  if (!exist()) return std::nullopt;
  auto newer = read(newer_);
  newer_is_sound_ = std::holds_alternative<Checkpoint>(newer);
  if (newer_is_sound_) return FoundCheckpoint{std::get<Checkpoint>(std::move(newer)), newer_, ""};
  auto older = read(older_);
  if (std::holds_alternative<Checkpoint>(older)) {
    return FoundCheckpoint{std::get<Checkpoint>(std::move(older)), older_, std::get<std::string>(newer)};
  }
  throw FileError(newer_, std::get<std::string>(newer) + ", and " + older_ + " " + std::get<std::string>(older),
                  "restore a copy, or move them away to start afresh");
}

void CheckpointFiles::write(const CheckpointIdentity& identity, const RunTime& time, std::span<const Bytes> stages) {
  const CheckpointPieces pieces(identity, time, stages);
  FileWriter writer(newer_, temporary_);
  writer.expect(pieces.size());
  pieces.for_each([&](std::span<const std::byte> piece) { writer.write(piece); });
  writer.sync();
  if (newer_is_sound_) put_at_second_name(newer_, older_);
  writer.commit();
  newer_is_sound_ = true;
}

void CheckpointFiles::remove() {
  // The newest last, so that what is left of a removal that was cut short is the newest.
  for (const std::string* path : {&temporary_, &older_, &newer_}) {
    std::error_code error;
    fs::remove(*path, error);
    if (error) throw FileError(*path, "cannot be removed (" + error.message() + ")", "remove it by hand");
  }
  newer_is_sound_ = false;
}

}  // namespace poesy
