#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/model/status.h"
#include "engine/python/solver/array_solver.h"
#include "engine/python/solver/arrays.h"
#include "engine/python/solver/docstrings.h"
#include "engine/python/solver/request.h"

namespace py = pybind11;

namespace poesy::python {
namespace {

using SharedSolver = std::shared_ptr<const ArraySolver>;
using Shape = std::vector<std::size_t>;

/// A solver that is bound to one pose.
struct AtPose {
  SharedSolver solver;
  std::vector<double> pose;  ///< [coordinates] SI, checked by ArraySolver::check_poses
};

/// Lets Ctrl-C end a long call. While the solver runs, Python notices Ctrl-C only if the solver asks for it, so the
/// solver calls this object from time to time, without holding the GIL.
class Interruption {
 public:
  void operator()() {
    constexpr auto kEvery = std::chrono::milliseconds(100);
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < kEvery) return;
    last_ = now;
    const py::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

constexpr char kWarning[] = "PoesyWarning";

/// Gives a warning of the class PoesyWarning. Throws if the user made warnings exceptions.
void warn(const std::string& text) {
  const py::object warning = py::module_::import("poesy_solver").attr(kWarning);
  if (PyErr_WarnEx(warning.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

/// The attribute of the class PoesyWarning that holds the set of the warnings that warn_once() already gave.
constexpr char kAsked[] = "_asked";

/// Gives a warning of what looks like a mistake in a mechanism, once in a process. Warnings that differ only in their
/// numbers count as the same warning, because an optimiser makes the mechanism with different numbers in each call.
void warn_once(const std::string& mechanism, const std::string& doubt) {
  std::string words = doubt;
  std::erase_if(words, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
  py::set asked = py::module_::import("poesy_solver").attr(kWarning).attr(kAsked);
  const py::str key(mechanism + ": " + words);
  if (asked.contains(key)) return;
  warn(doubt);
  asked.add(key);
}

/// Refuses poses that the mechanism does not reach, and warns of those far outside its workspace.
void check_poses(const ArraySolver& solver, std::span<const double> poses) {
  solver.check_poses(poses);
  if (const std::string text = solver.far_poses(poses); !text.empty()) warn(text);
}

/// Solves a job without the GIL, so that other threads of Python run meanwhile.
void solve_without_gil(const ArraySolver& solver, const ArrayJob& job) {
  const std::size_t poses = job.poses.size() / solver.description().pose_coordinates.size();
  const std::size_t errors = (job.step > 0 ? poses : 1) * solver.factors().size() * job.samples;
  const std::size_t responses = poses * solver.description().responses.size() * job.samples;
  check_apart(std::array{Memory{"errors", job.errors, errors * sizeof(double)},
                         Memory{"out", job.responses, responses * sizeof(double)},
                         Memory{"status", job.status, poses * job.samples}});
  const py::gil_scoped_release release;
  solver.solve(job, Interruption());
}

template <class Things, class Text>
py::tuple tuple_of(const Things& things, const Text& text) {
  py::list list;
  for (const auto& thing : things) list.append(std::string(text(thing)));
  return py::tuple(list);
}

template <class Things>
py::tuple names_of(const Things& things) {
  return tuple_of(things, [](const auto& thing) { return thing.name; });
}

template <class Things>
py::tuple units_of(const Things& things) {
  return tuple_of(things, [](const auto& thing) { return si_unit(thing.dimension); });
}

std::vector<Factor> errors_of(const ArraySolver& solver) {
  std::vector<Factor> list;
  for (const FactorIndex factor : solver.factors()) list.push_back(solver.description().factors[factor.value]);
  return list;
}

py::dict units(const ArraySolver& solver) {
  py::dict units;
  units["errors"] = units_of(errors_of(solver));
  units["responses"] = units_of(solver.description().responses);
  units["pose_coordinates"] = units_of(solver.description().pose_coordinates);
  return units;
}

/// The mechanism that a caller in Python names: a name of the catalog, or a path. A path object is always a path, so
/// "./" is put in front of a path object without a folder.
std::string mechanism_text(const py::object& mechanism) {
  const auto text = py::module_::import("os").attr("fspath")(mechanism).cast<std::string>();
  const bool is_bare = text.find('/') == std::string::npos;
  return !py::isinstance<py::str>(mechanism) && is_bare ? "./" + text : text;
}

using Factors = std::variant<std::string, std::vector<std::string>>;

std::shared_ptr<ArraySolver> make_solver(const py::object& mechanism, const std::string& metric,
                                         const std::string& fidelity, const Factors& factors, bool calibrated,
                                         const std::map<std::string, GeometryValue>& geometry) {
  const Request request{.mechanism = mechanism_text(mechanism),
                        .metric = metric,
                        .fidelity = fidelity,
                        .factors = factors,
                        .calibrated = calibrated,
                        .geometry = geometry};
  auto solver = std::make_shared<ArraySolver>(study_of(request));
  for (const std::string& doubt : solver->doubts()) warn_once(request.mechanism, doubt);
  return solver;
}

AtPose at(const std::shared_ptr<ArraySolver>& solver, const py::object& pose) {
  AtPose bound{solver, pose_numbers(pose, 1, solver->description())};
  check_poses(*solver, bound.pose);
  return bound;
}

py::object solve_at(const AtPose& bound, const py::object& errors, const py::object& out, const py::object& status) {
  const ArraySolver& solver = *bound.solver;
  const ErrorArray given = error_array(errors, solver.factors().size());
  SolveStatus* const ends = status_array(status, {given.samples});
  py::array_t<double> responses = response_array(out, solver.description().responses.size(), given);
  solve_without_gil(solver, {bound.pose, given.data, 0, given.samples, responses.mutable_data(), ends});
  return responses;
}

py::object solve_many(const ArraySolver& solver, const py::object& poses, const py::object& errors,
                      const py::object& out, const py::object& status, bool paired) {
  const std::vector<double> numbers = pose_numbers(poses, 2, solver.description());
  const std::size_t count = numbers.size() / solver.description().pose_coordinates.size();
  const std::size_t varied = solver.factors().size();
  const ErrorArray given = paired ? ErrorArray{paired_error_array(errors, count, varied), 1, Layout::one_sample}
                                  : shared_error_array(errors, varied);
  Shape shape{count, solver.description().responses.size()};
  Shape status_shape{count};
  if (given.layout == Layout::rows) {
    shape.push_back(given.samples);
    status_shape.push_back(given.samples);
  }
  SolveStatus* const ends = status_array(status, status_shape);
  py::array_t<double> responses = response_block(out, shape);
  check_poses(solver, numbers);
  solve_without_gil(solver, {numbers, given.data, paired ? varied : 0, given.samples, responses.mutable_data(), ends});
  return responses;
}

void add_warning(py::module_& module) {
  module.attr(kWarning) = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc("poesy_solver.PoesyWarning", kWarningText, PyExc_UserWarning, nullptr));
  module.attr(kWarning).attr(kAsked) = py::set();
}

void add_status(py::module_& module) {
  py::dict values;
  // The number of statuses before by_series, which does not occur here, because this module solves each sample.
  constexpr auto kOfSolves = static_cast<std::size_t>(SolveStatus::by_series);
  for (std::size_t s = 0; s < kOfSolves; ++s) values[std::string(kStatusNames[s]).c_str()] = s;
  py::object status = py::module_::import("enum").attr("IntEnum")("Status", values);
  status.attr("__module__") = module.attr("__name__");
  status.attr("__doc__") = kStatusText;
  module.attr("Status") = status;
}

std::string evaluator_text(const ArraySolver& solver) {
  return fmt::format("<poesy_solver.Evaluator of {}: {} errors, {} responses>", solver.description().name,
                     solver.factors().size(), solver.description().responses.size());
}

void add_evaluator(py::module_& module) {
  py::class_<ArraySolver, std::shared_ptr<ArraySolver>>(module, "Evaluator", kEvaluatorText)
      .def(py::init(&make_solver), kInitText, py::arg("mechanism"), py::kw_only(), py::arg("metric") = "platform",
           py::arg("fidelity") = "exact", py::arg("factors") = "all", py::arg("calibrated") = false,
           py::arg("geometry") = std::map<std::string, GeometryValue>())
      .def_property_readonly(
          "mechanism", [](const ArraySolver& solver) { return solver.description().name; }, kMechanismText)
      .def_property_readonly(
          "errors", [](const ArraySolver& solver) { return names_of(errors_of(solver)); }, kErrorsText)
      .def_property_readonly(
          "responses", [](const ArraySolver& solver) { return names_of(solver.description().responses); },
          kResponsesText)
      .def_property_readonly(
          "pose_coordinates", [](const ArraySolver& solver) { return names_of(solver.description().pose_coordinates); },
          kPoseCoordinatesText)
      .def_property_readonly("units", &units, kUnitsText)
      .def("at", &at, kAtText, py::arg("pose"))
      .def("__call__", &solve_many, kCallText, py::arg("poses"), py::arg("errors"), py::arg("out") = py::none(),
           py::arg("status") = py::none(), py::kw_only(), py::arg("paired") = false)
      .def("__repr__", &evaluator_text);
}

void add_at_pose(py::module_& module) {
  py::class_<AtPose>(module, "AtPose", kAtPoseText)
      .def_property_readonly(
          "pose", [](const AtPose& bound) { return py::tuple(py::cast(bound.pose)); }, kPoseText)
      .def("__call__", &solve_at, kCallAtPoseText, py::arg("errors"), py::arg("out") = py::none(),
           py::arg("status") = py::none());
}

}  // namespace
}  // namespace poesy::python

PYBIND11_MODULE(poesy_solver, module) {
  using namespace poesy::python;
  py::options options;
  options.disable_function_signatures();  // the docstrings begin with signatures of their own
  module.doc() = kModuleText;
  module.attr("__version__") = POESY_VERSION;
  py::register_exception<poesy::InputError>(module, "InputError", PyExc_ValueError).doc() = kInputErrorText;
  py::register_exception<poesy::FileError>(module, "FileError", PyExc_OSError).doc() = kFileErrorText;
  add_warning(module);
  add_status(module);
  add_at_pose(module);
  add_evaluator(module);
}
