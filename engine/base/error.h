#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace poesy {

/// Where in a text file something stands. Line and column count from 1; 0 means unknown.
struct Place {
  std::string file;        ///< as the user named it; empty where there is none
  std::size_t line = 0;    ///< counts from 1; 0 where there is none
  std::size_t column = 0;  ///< counts from 1, in bytes; 0 where there is none
};

/// "FILE", "FILE:LINE" or "FILE:LINE:COL", as much as is known; empty where there is no file.
std::string to_string(const Place& place);

/// Said of std::bad_alloc where it is not known how much is needed; it is a FileError by its exit code.
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
