#include "engine/app/changed_result.h"

#include "engine/app/message.h"

namespace poesy::app {

StoredResult read_result_warily(const std::string& path) {
  StoredResult result = read_result(path);
  if (result.changed) say(Message::warning, path + " was changed since it was written; see poesy verify");
  return result;
}

}  // namespace poesy::app
