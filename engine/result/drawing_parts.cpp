#include "engine/result/drawing_parts.h"

#include "engine/result/result_parts.h"

namespace poesy {
namespace {

const Group<DrawingResult> kDrawing{
    "/drawing",
    "What the features of the drawing do in their zones, to first order and alone: other errors are not in it. NaN for "
    "a "
    "response that is neither signed nor the norm of signed ones, and where a pose was not solved",
    {},
    {},
    {{"label", &DrawingResult::label, "1", "Name on the drawing, the same in all limbs"},
     {"limb", &DrawingResult::limb, "1", "Limb, from 1"},
     {"kind", &DrawingResult::kind, "1", "axis, rectangle, round, point or distance"},
     {"length", &DrawingResult::length, "m", "Length of an axis, first side or diameter of a plane; 0: none"},
     {"location", &DrawingResult::location, "1",
      "Zone of location, tolerance of a distance, or clearance; \"-\": none"},
     {"location_zone", &DrawingResult::location_zone, "m",
      "Its width or diameter as written; of a distance +- this; of a clearance the largest"},
     {"location_datums", &DrawingResult::location_datums, "1", "Its datums; \"-\": none"},
     {"orientation", &DrawingResult::orientation, "1", "Zone of orientation; \"-\": none"},
     {"orientation_zone", &DrawingResult::orientation_zone, "m", "Its width or diameter as written"},
     {"orientation_datums", &DrawingResult::orientation_datums, "1", "Its datums; \"-\": none"},
     {"sigmas", &DrawingResult::sigmas, "1",
      "Half a zone in standard deviations of a coordinate of an extreme point, before an inspection; 0: a clearance, "
      "or "
      "not by standard deviations"},
     {"effect", &DrawingResult::effect, kResponseUnit,
      "Root mean square of the response by this feature alone, over the poses"},
     {"share", &DrawingResult::share, "1", "Share of the mean square of all features together, over the poses"},
     {"rms", &DrawingResult::rms, kResponseUnit,
      "Root mean square by all features, each location divided evenly between middle and tilt"},
     {"rms_worst_division", &DrawingResult::rms_worst_division, kResponseUnit,
      "The same with each location that has no orientation divided as is worst for the mean square: into the middle "
      "alone or the tilt alone"},
     {"worst_case", &DrawingResult::worst_case, kResponseUnit,
      "The largest magnitude with all features in their zones; of a norm the largest that was found"},
     {"worst_share", &DrawingResult::worst_share, "1",
      "Share of each feature in the worst case, at the pose where it is largest"}}};

}  // namespace

void write_drawing(ResultBuilder& result, const DrawingResult& found) {
  result.add_axis("feature", found.names, {"1", "Features of the drawing, with their limbs"});
  write_group(result, kDrawing, found);
}

DrawingResult read_drawing(const h5::File& file) {
  DrawingResult found;
  read_group(file, kDrawing, found);
  found.names = file.read<std::string>("/feature");
  check_names(found.names, "/feature");
  return found;
}

void append_drawing_tables(CsvTables& tables, const std::vector<std::string>& responses, const DrawingResult& found) {
  const std::size_t features = found.features();
  CsvTable table{"features",
                 {"response", [&, features](std::size_t line) { return responses[line / features]; }},
                 responses.size() * features};
  const auto of = [features](const auto& array) {
    return [&array, features](std::size_t line) { return array(line / features, line % features); };
  };
  const auto number = [features](const DrawingResult::Sizes& array) {
    return [&array, features](std::size_t line) { return array(line % features); };
  };
  const auto text = [features](const DrawingResult::Texts& array) {
    return [&array, features](std::size_t line) {
      const std::string& zone = array(line % features);
      return zone == "-" ? std::string() : zone;
    };
  };
  table.more = {{"feature", [&, features](std::size_t line) { return found.names[line % features]; }},
                {"location", text(found.location)},
                {"orientation", text(found.orientation)}};
  table.columns = {{"location_zone [m]", number(found.location_zone)},
                   {"orientation_zone [m]", number(found.orientation_zone)},
                   {"effect [SI]", of(found.effect)},
                   {"share", of(found.share)},
                   {"worst_share", of(found.worst_share)}};
  tables.push_back(std::move(table));
}

}  // namespace poesy
