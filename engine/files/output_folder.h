#pragma once

#include <map>
#include <string>
#include <vector>

namespace poesy {

void make_folder(const std::string& folder);  ///< Makes a folder if it is missing. Throws FileError.

/// A folder into which a command writes several files, and in which the user may keep files of his own.
///
/// poesy lists in FOLDER/poesy.sha256 what it wrote there, as sha256sum does ("HASH  NAME"), and replaces only
/// files that are listed and that nobody has changed since. Use it in this order:
///
///     OutputFolder folder("tables");
///     folder.claim("poses.csv"); ...          // every file, before the first is written
///     folder.open();
///     ...                                     // write the files that were claimed
///     folder.close();
///
/// A command that is killed between open() and close() leaves files that the next one may replace.
class OutputFolder {
 public:
  /// The folder need not exist. Throws InputError when its poesy.sha256 is no such list, FileError when it cannot be
  /// read.
  explicit OutputFolder(std::string path);

  /// Throws InputError when the command must not replace what has this name: a file that poesy did not write, or that
  /// was changed since, or something other than a plain file (a folder, a symbolic link).
  void claim(const std::string& name);

  /// Makes the folder if it is missing, and notes there that the claimed files are being written. Throws FileError.
  void open();
  void close();  ///< Lists the claimed files with their hashes. Throws FileError.

  std::string file(const std::string& name) const;  ///< The path of a file in the folder.

 private:
  void read_line(const std::string& line);
  void write_list() const;

  std::string path_;
  std::map<std::string, std::string> hashes_;  ///< by name; empty while the file is being written
  std::vector<std::string> claimed_;
};

/// The file in which a folder lists what poesy wrote into it.
inline constexpr const char* kListOfFiles = "poesy.sha256";

}  // namespace poesy
