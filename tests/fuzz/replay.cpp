// Runs a fuzz target over the files in the folders on the command line. Every file in a folder `corpus` is a seed and
// must be accepted, except found_* (found by a fuzzer) and refused_* (meant to be refused). A fuzzer hardly gets past a
// check that refuses its seeds.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

namespace {

bool is_seed(const std::filesystem::path& path) {
  const std::string name = path.filename();
  return path.parent_path().parent_path().filename() == "corpus" && !name.starts_with("found_") &&
         !name.starts_with("refused_");
}

void run(const std::filesystem::path& path) {
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);  // if the program dies, the last line names the file
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::vector<std::uint8_t> input(bytes.begin(),
                                        bytes.end());  // exact size, so that reading beyond it is noticed
  const std::size_t before = poesy::fuzz::accepted_reads;
  LLVMFuzzerTestOneInput(input.data(), input.size());
  poesy::fuzz::expect(!is_seed(path) || poesy::fuzz::accepted_reads > before, "a seed is accepted");
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t files = 0;
  for (int k = 1; k < argc; ++k) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[k])) {
      run(entry.path());
      ++files;
    }
  }
  return files > 0 ? 0 : 1;
}
