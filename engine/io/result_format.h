#pragma once

#include <cstdint>
#include <string_view>

/// The words that writer and reader of result files share.
namespace poesy::result_format {

/// The attribute that says what a file is.
/// @{
inline constexpr std::string_view kFileType = "poesy-result";
inline constexpr std::string_view kShardFileType = "poesy-shard";
/// @}
/// A reader refuses a newer major version; a minor version only adds.
inline constexpr std::int64_t kMajor = 1;
inline constexpr std::int64_t kMinor = 0;  ///< from the first release on grows with what older programs may pass over

/// Kinds of results, as files name them.
/// @{
inline constexpr std::string_view kSensitivity = "sensitivity";
inline constexpr std::string_view kEvaluate = "evaluate";
inline constexpr std::string_view kIdentification = "identification";
inline constexpr std::string_view kMonteCarlo = "monte-carlo";
inline constexpr std::string_view kCoupling = "coupling";
/// @}

/// How poses and rows of errors belong together, as files say it.
/// @{
inline constexpr std::string_view kRowByRow = "row-by-row";
inline constexpr std::string_view kEveryPoseWithEveryRow = "every-pose-with-every-row";
/// @}

}  // namespace poesy::result_format
