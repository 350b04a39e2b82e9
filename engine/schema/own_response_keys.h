#pragma once

#include <string>
#include <vector>

#include "engine/model/own_responses.h"
#include "engine/schema/keys.h"

/// The tables [[response]] of studies and mechanism files, in which users define responses.
namespace poesy {

/// Whether responses of a table [[response]] may be relative to the previous pose.
enum class PoseBefore {
  known,   ///< yes: the file has a list of poses
  unknown  ///< no: the file has no list of poses
};

/// The description of tables [[response]] and their inner tables, for the reference.
StudyTables own_response_tables();

/// Reads a list of tables [[response]] for a model with this description. If a norm NAME is relative to a pose, also
/// adds for each response MEMBER in the norm a response NAME_MEMBER, which is the difference of MEMBER from its value
/// at this pose. Throws InputError if a table is not valid.
std::vector<OwnResponse> read_own_responses(const StudyValue& value, ModelDescription model, PoseBefore before);

/// The responses as tables [[response]]. Reading these tables gives exactly the same responses. model: the description
/// with these responses appended.
std::string own_responses_text(const std::vector<OwnResponse>& own, const ModelDescription& model);

}  // namespace poesy
