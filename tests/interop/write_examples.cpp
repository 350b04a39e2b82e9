// Writes example results and their tables into the folder on the command line, for programs in other languages to read.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "engine/run/evaluation.h"
#include "tests/engine/kinds/example_result.h"

int main(int argc, char** argv) try {
  using poesy::Pairing;
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[1];
  poesy::test::Example example;
  example.write_sensitivity(folder + "/sensitivity.h5");
  example.write_evaluation(folder + "/evaluate.h5", Pairing::every_pose_with_every_row);
  example.write_evaluation(folder + "/paired.h5", Pairing::row_by_row);
  example.write_monte_carlo(folder + "/monte_carlo.h5");
  example.write_coupling(folder + "/coupling.h5");
  poesy::test::Example().write_cases(folder + "/cases.h5");
  poesy::test::Example().write_machines(folder + "/machines.h5");
  poesy::test::Example().write_sobol(folder + "/sobol.h5");
  poesy::test::Example of_tolerances;
  of_tolerances.write_allocation(folder + "/allocation.h5", of_tolerances.allocation());
  poesy::test::Example().write_identification(folder + "/identification.h5");
  for (const char* name : {"/sensitivity", "/evaluate", "/paired", "/monte_carlo", "/machines", "/sobol", "/allocation",
                           "/coupling", "/cases", "/identification"}) {
    std::filesystem::remove_all(folder + name);  // a build folder may have tables of an earlier version
    poesy::export_tables(folder + name + ".h5", folder + name);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
