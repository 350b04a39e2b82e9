#include "engine/app/reference.h"

#include <array>

namespace poesy::app {

std::span<const Entry> exit_codes() {
  static constexpr std::array kEntries{
      Entry{"0", "done"},
      Entry{"1", "internal error; please report it"},
      Entry{"2", "bad command line, study or data; nothing is written"},
      Entry{"3", "a file cannot be read, written or trusted"},
      Entry{"4", "interrupted: poesy run goes on with --resume, poesy evaluate wrote nothing"},
      Entry{"5", "done and the result kept, but more samples failed to converge than the study allows"},
      Entry{"6", "done and the result kept, but a limit that the study states is not kept; 5 goes before it"}};
  return kEntries;
}

std::span<const Entry> files() {
  static constexpr std::array kEntries{
      Entry{"STUDY.toml", "what to compute; poesy template writes one to start from"},
      Entry{"RESULT.h5", "what was found; HDF5, whole or absent"},
      Entry{"RESULT.h5.part", "checkpoint of a run; the one before it is RESULT.h5.part.1"},
      Entry{"RESULT.h5.lock", "there while a run writes to this result"}};
  return kEntries;
}

std::span<const Entry> environment() {
  static constexpr std::array kEntries{
      Entry{"NO_COLOR", "if it is set and not empty, nothing is coloured"},
      Entry{"TERM", "if it is unset or 'dumb', nothing is coloured, and progress comes line by line"},
      Entry{"POESY_ISA", "instruction set of the kernels, instead of the best that the processor has"}};
  return kEntries;
}

}  // namespace poesy::app
