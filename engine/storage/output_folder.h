#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace poesy {

void make_folder(const std::string& folder);  ///< Makes a folder if it is missing. Throws FileError.

/// A folder into which a command writes several files of one result. Users may keep their own files in it.
///
/// The manifest FOLDER/poesy_manifest.txt states the content_sha256 of the result, and the names of the files that
/// poesy wrote into the folder, one per line. poesy replaces and removes only files that are listed and that are not
/// newer than the manifest. All listed files belong to one result: when the files of a new result are written, those of
/// the earlier result are removed. Use the class in this order:
///
///     OutputFolder folder("tables", result.content_sha256);
///     folder.claim("poses.csv"); ...          // every file, before the first is written
///     folder.fill([&] { ... });               // writes the files that were claimed
///
/// If a command is killed, old and new files remain. The next command replaces or removes them.
class OutputFolder {
 public:
  /// path: the folder, which need not exist. result: content_sha256 of the result; if it is not known (empty), fill()
  /// removes all files that the manifest lists, except those that are claimed. Throws InputError if the folder has a
  /// poesy_manifest.txt that poesy did not write.
  OutputFolder(std::string path, const std::string& result);

  /// Announces that the command will write this file. Throws InputError if the file exists and must not be replaced:
  /// poesy did not write it, it was changed since then, or it is not a plain file (a folder, a symbolic link).
  void claim(const std::string& name);

  /// Makes the folder if it is missing, and records that the claimed files are being written. Then calls write(), which
  /// must write each file completely or not at all. Finally removes the files of other results and lists the claimed
  /// files. Throws InputError, before anything is written, if it would have to remove a file that claim() would refuse.
  /// If write() throws FileError, adds the number of new files to the message.
  void fill(const std::function<void()>& write);

  std::string file(const std::string& name) const;  ///< The path of a file in the folder.

 private:
  void read_manifest();
  void check(const std::string& name) const;
  void remove(const std::set<std::string>& names) const;
  std::string what_is_there() const;
  void write_manifest(const std::string& state, const std::set<std::string>& names) const;

  std::string path_;
  std::string result_;
  std::string listed_result_;      ///< content_sha256 that the manifest states
  bool unfinished_ = false;        ///< true if an earlier command did not finish
  std::set<std::string> listed_;   ///< names in the manifest
  std::set<std::string> changed_;  ///< listed files that are newer than the manifest
  /// [claimed names] inode number of the file before it was written; 0 if there was no file.
  std::map<std::string, ino_t> claimed_;
};

/// The name of the file that lists what poesy wrote into a folder.
inline constexpr const char* kManifest = "poesy_manifest.txt";

}  // namespace poesy
