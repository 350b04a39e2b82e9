#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace poesy {

void make_folder(const std::string& folder);  ///< Makes a folder if it is missing. Throws FileError.

/// A folder into which a command writes several files of one result, and in which the user may keep files of his own.
///
/// FOLDER/poesy_manifest.txt names the result by its content_sha256 and lists what poesy wrote there, a name on each
/// line. poesy replaces and removes only files that are listed and were not changed after the manifest. All files in a
/// folder are of one result: those of another one go when the new ones are there. Use it in this order:
///
///     OutputFolder folder("tables", result.content_sha256);
///     folder.claim("poses.csv"); ...          // every file, before the first is written
///     folder.fill([&] { ... });               // writes the files that were claimed
///
/// A command that is killed meanwhile leaves old and new files, which the next one replaces or removes.
class OutputFolder {
 public:
  /// The folder need not exist. result: its content_sha256; empty for a result that is not known, whose files stay
  /// with no others. Throws InputError when the folder's poesy_manifest.txt was not written by poesy.
  OutputFolder(std::string path, const std::string& result);

  /// Throws InputError when the command must not replace what has this name: a file that poesy did not write, or that
  /// was changed since, or something other than a plain file (a folder, a symbolic link).
  void claim(const std::string& name);

  /// Makes the folder if it is missing, notes there that the claimed files are being written, calls write(), which
  /// writes each of them whole or not at all, removes the files of other results, and lists the claimed ones. Throws
  /// InputError, before anything is written, for a file of another result that claim() would refuse; FileError, which
  /// says how many files are new when write() throws it.
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
  std::string listed_result_;             ///< the result that the manifest names
  bool unfinished_ = false;               ///< a command ended before it was done
  std::set<std::string> listed_;          ///< names in the manifest
  std::set<std::string> changed_;         ///< of these, the files that are newer than the manifest
  std::map<std::string, ino_t> claimed_;  ///< by name: the file that was there before; 0: none
};

/// The file in which a folder lists what poesy wrote into it.
inline constexpr const char* kManifest = "poesy_manifest.txt";

}  // namespace poesy
