#pragma once

#include <string>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

/// The errors of an allocation that vary but are in no part. The search does not choose their sizes. Search and
/// certificate draw them with the sizes that the study states, so the certificate is valid only for these sizes.
namespace poesy::allocation {

/// An error that varies and is in no part, with the distribution with which it is drawn.
struct UnallocatedError {
  NamedUnit named;           ///< name and SI unit
  std::string distribution;  ///< name of the distribution: "normal"
  double sigma;              ///< standard deviation, SI
  bool is_per_pose = false;  ///< true if a machine draws it anew at each pose, so that no part can have it
};

std::vector<UnallocatedError> errors_in_no_part(const Study& study);          ///< The errors in no part of a study.
std::vector<UnallocatedError> errors_in_no_part(const StoredResult& result);  ///< The errors in no part of a result.

/// A clause with the names and sizes of these errors: "9 of 39 varied errors are in no part; their sizes stay as
/// [errors] states them: ball_left_x_1, ball_left_x_2, ball_left_x_3 and 6 more (normal, sigma 0.02 mm)". Empty if
/// there are no such errors. all: number of all varied errors.
std::string in_no_part_text(const std::vector<UnallocatedError>& errors, std::size_t all);

/// A table with the size of each of these errors. Precondition: there are such errors.
Table in_no_part_table(const std::vector<UnallocatedError>& errors);

}  // namespace poesy::allocation
