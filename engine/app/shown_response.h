#pragma once

#include <string>

#include "engine/result/result_file.h"

/// The response that tables of a result show if the user names one.
namespace poesy::app {

/// The name of the response to show: `wanted`, or, if this is empty, the response by which errors are ranked by
/// default. If the kind of the result ranks no errors and `wanted` is not empty, the response becomes the only one of
/// the result's headline, so that tables show it alone. Throws InputError if the result lacks the response. path: path
/// of the result, for the message.
std::string choose_response(const std::string& wanted, const std::string& path, StoredResult& result);

/// The name of the response to show, as choose_response() returns it, but without changing the result.
std::string response_of(const std::string& wanted, const std::string& path, const StoredResult& result);

}  // namespace poesy::app
