#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace poesy {

void make_folder(const std::string& folder);  ///< Makes a folder if it is missing. Throws FileError.

/// A folder into which a command writes several files of one result, and in which the user may keep files of his own.
///
/// poesy lists in FOLDER/poesy.sha256 what it wrote there, as sha256sum does ("HASH  NAME"), below the result that it
/// is of ("# content_sha256 HASH"). It replaces and removes only files that are listed and that nobody has changed
/// since. All files in a folder are of one result: those of another one go when the new ones are there. Use it in this
/// order:
///
///     OutputFolder folder("tables", result.content_sha256);
///     folder.claim("poses.csv"); ...          // every file, before the first is written
///     folder.fill([&] { ... });               // writes the files that were claimed
///
/// A command that is killed meanwhile leaves old and new files, which the next one may replace and remove.
class OutputFolder {
 public:
  /// The folder need not exist. result: its content_sha256; anything else is a result that is not known, whose files
  /// stay with no others. Throws InputError when the folder's poesy.sha256 is no such list, FileError when it cannot be
  /// read.
  OutputFolder(std::string path, const std::string& result);

  /// Throws InputError when the command must not replace what has this name: a file that poesy did not write, or that
  /// was changed since, or something other than a plain file (a folder, a symbolic link).
  void claim(const std::string& name);

  /// Makes the folder if it is missing, notes there that the claimed files are being written, calls write(), which
  /// writes each of them whole or not at all, removes the files of other results, and lists the claimed ones with their
  /// hashes. Throws InputError, before anything is written, for a file of another result that claim() would refuse;
  /// FileError, which says how many files are new when write() throws it.
  void fill(const std::function<void()>& write);

  std::string file(const std::string& name) const;  ///< The path of a file in the folder.

 private:
  /// A file that poesy wrote.
  struct Listed {
    std::string hash;    ///< empty while the file is being written
    std::string result;  ///< content_sha256 of the result that it is of; empty: not known
  };

  void read_line(const std::string& line, std::string& result);
  void check(const std::string& name) const;
  void remove(const std::vector<std::string>& names);
  std::string what_is_there() const;
  void write_list() const;

  std::string path_;
  std::string result_;
  std::map<std::string, Listed> listed_;        ///< by name
  std::map<std::string, std::string> claimed_;  ///< by name: hash of the file that was there; empty: there was none
};

/// The file in which a folder lists what poesy wrote into it.
inline constexpr const char* kListOfFiles = "poesy.sha256";

}  // namespace poesy
