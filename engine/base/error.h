#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace poesy {

/// A place in a text file. Line and column count from 1; 0 means unknown.
struct Place {
  std::string file;        ///< name that the user gave; empty if there is none
  std::size_t line = 0;    ///< counts from 1; 0 if unknown
  std::size_t column = 0;  ///< counts from 1, in bytes; 0 if unknown
};

/// The place as text, as far as known: "FILE", "FILE:LINE" or "FILE:LINE:COL"; empty without a file.
std::string to_string(const Place& place);

/// The message for std::bad_alloc if the needed memory is not known; its exit code is that of FileError.
inline constexpr const char* kTooLittleMemory =
    "there is not enough memory for this; end other programs, raise the limit (ulimit -v), or ask for less";

/// The user's command line, study or data is wrong. Ends the program with exit code 2.
/// what() reads "FILE:LINE:COL: problem; remedy".
class InputError : public std::runtime_error {
 public:
  /// One line: the place, what is wrong, and what to do.
  InputError(const Place& place, std::string_view problem, std::string_view remedy);
};

/// A file cannot be read, written or trusted. Ends the program with exit code 3.
/// what() reads "PATH: problem; remedy".
class FileError : public std::runtime_error {
 public:
  /// One line: the file, what is wrong, and what to do.
  FileError(std::string_view path, std::string_view problem, std::string_view remedy);
};

}  // namespace poesy
