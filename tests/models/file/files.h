#pragma once

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// The text of tests/data/mechanisms/NAME.toml or, if there is none, of results/gallery/NAME/NAME.toml.
inline std::string text_of(const std::string& name) {
  std::ifstream file(POESY_TEST_DATA "/mechanisms/" + name + ".toml");
  if (!file) file.open(POESY_TEST_DATA "/../../results/gallery/" + name + "/" + name + ".toml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The mechanism of this file (see text_of()) with its default geometry.
inline Mechanism from_file(const std::string& name) {
  const MechanismFile file = read_mechanism_file(text_of(name), name + ".toml");
  return mechanism(file, default_geometry(file));
}

/// The model of this catalog entry, with its default geometry.
inline std::unique_ptr<Model> build(const CatalogEntry& entry, std::size_t fidelity = 0) {
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, fidelity);
}

}  // namespace poesy::file
