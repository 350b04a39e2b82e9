#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace poesy {

/// A place in a text file. Line and column count from 1; 0 means unknown.
struct Place {
  std::string file;        ///< name of the file as the user gave it; empty if there is none
  std::size_t line = 0;    ///< line number, from 1; 0 if unknown
  std::size_t column = 0;  ///< column in bytes, from 1; 0 if unknown
};

/// The place as text, as far as known: "FILE", "FILE:LINE" or "FILE:LINE:COL"; empty without a file.
std::string to_string(const Place& place);

/// The message of the program for a std::bad_alloc of unknown size. The program then ends with exit code 3, as for a
/// FileError.
inline constexpr const char* kTooLittleMemory =
    "there is not enough memory for this; end other programs, raise the limit (ulimit -v), or ask for less";

/// The exception for a mistake in the user's command line, study or data. It ends the program with exit code 2. what()
/// reads "FILE:LINE:COL: problem; remedy".
class InputError : public std::runtime_error {
 public:
  /// problem: what is wrong; remedy: what to do. The message is one line.
  InputError(const Place& place, std::string_view problem, std::string_view remedy);
};

/// The exception for a file that cannot be read, written or trusted. It ends the program with exit code 3. what() reads
/// "PATH: problem; remedy".
class FileError : public std::runtime_error {
 public:
  /// problem: what is wrong; remedy: what to do. The message is one line.
  FileError(std::string_view path, std::string_view problem, std::string_view remedy);
};

}  // namespace poesy
