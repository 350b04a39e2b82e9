// Runs a fuzz target over the files of the folders on the command line. A seed must be accepted, because a fuzzer
// hardly gets past the check that refuses its seeds. Every file in a folder `corpus` is a seed, except found_*, which a
// fuzzer found, and refused_*, which are meant to be refused.
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
  std::fflush(stdout);  // the last line names the file that the program died of
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::vector<std::uint8_t> input(bytes.begin(),
                                        bytes.end());  // of this size exactly: no byte may be read beyond
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
