#pragma once

#include <string>
#include <vector>

#include "engine/model/own_responses.h"
#include "engine/schema/keys.h"

/// The tables [[response]] of studies and mechanism files.
namespace poesy {

/// Whether a response may be relative to the pose before it.
enum class PoseBefore {
  known,   ///< the file has a list of poses
  unknown  ///< it has none
};

/// The tables with every key, for the reference.
StudyTables own_response_tables();

/// Reads a list of such tables for a model with this description. A norm that is relative to a pose also gives the
/// differences of its members, as NAME_MEMBER. Throws InputError.
std::vector<OwnResponse> read_own_responses(const StudyValue& value, ModelDescription model, PoseBefore before);

/// The responses as tables, which read back exactly; their positions are those of a model with them.
std::string own_responses_text(const std::vector<OwnResponse>& own, const ModelDescription& model);

}  // namespace poesy
