#include "engine/app/exit_code_of.h"

#include <exception>

#include "engine/app/launch.h"
#include "engine/app/message.h"
#include "engine/base/error.h"

namespace poesy::app {

int complain(const std::string& problem, ExitCode code) {
  if (find_launch().value_or(Launch()).rank == 0) say(Message::error, problem);
  return code;
}

int exit_code_of(const std::function<int()>& action) {
  try {
    return action();
  } catch (const InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const FileError& error) {
    return complain(error.what(), kFileTrouble);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what() + "; please report it", kInternalError);
  }
}

}  // namespace poesy::app
