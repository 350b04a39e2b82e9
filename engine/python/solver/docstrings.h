#pragma once

/// The texts that help() shows in Python. The types are in the stub poesy_solver.pyi.
namespace poesy::python {

inline constexpr char kModuleText[] = R"(What errors do to a mechanism, solved directly in NumPy arrays.

    import numpy as np, poesy_solver
    e = poesy_solver.Evaluator("robot.toml")
    at_pose = e.at([0.1, 0.0, 0.6])                # the numbers of e.pose_coordinates, m and rad
    errors = np.random.normal(0.0, 1e-4, (len(e.errors), 1000))
    responses = at_pose(errors)                    # (len(e.responses), 1000)

All numbers are in SI: metres and radians, of poses, errors and responses. Errors are an array (P, B) with a row for
each of P errors and a column for each of B samples; responses are an array (R, B). Arrays are float64 and contiguous,
and they are used without a copy; other arrays are refused, never converted. While a call solves, other threads of
Python can run, and several threads may call one evaluator.)";

inline constexpr char kInputErrorText[] = "The solver cannot do what was asked; the message says why. A ValueError.";
inline constexpr char kWarningText[] =
    "Poses far outside the workspace, or geometry that may be a mistake. A UserWarning; once for each evaluator.";
inline constexpr char kFileErrorText[] = "A file cannot be read; the message says why. An OSError.";

inline constexpr char kStatusText[] = R"(How one solve ended: the numbers of status arrays, names as in result files.

converged and stagnated (as exact as the arithmetic allows) are solutions. iteration_cap, singular, non_finite and
not_assembled (the loops of this machine cannot be closed) are none: their responses are NaN.)";

inline constexpr char kEvaluatorText[] = R"(A mechanism and the errors that are given of it.

Threads may call one evaluator at the same time; each call has working memory of its own, which is kept for the next.)";

inline constexpr char kInitText[] =
    R"(Evaluator(mechanism, *, metric="platform", fidelity="exact", factors="all", calibrated=False, geometry={})

mechanism   a name of the catalog (`poesy models` lists them), or a mechanism's file: a path object, or a text that
            ends in ".toml" or holds a "/".
metric      "platform" or "published": how mismatch of angle is weighed against mismatch of position. "platform" is
            passed over where nothing is weighed. (A study file without the key may take "published".) "stiffness", for
            a file whose parts have it: in equilibrium, with forces. (A study file without the key takes it there.)
fidelity    "exact", or "first-order" where the mechanism has it.
factors     the errors that are given, in the order of the rows of an array: a factor set, "all", or a list of names.
            The others are zero.
calibrated  True: responses are what remains with the drives corrected at each pose, best for metric_points.
geometry    parameters of the geometry that differ from those of the mechanism: {"a": 0.26} in SI, or {"a": "260 mm"}.

Raises InputError and FileError with the program's sentence.)";

inline constexpr char kMechanismText[] = "Name of the mechanism.";
inline constexpr char kErrorsText[] = "Names of the errors, P of them, in the order of the rows of an array.";
inline constexpr char kResponsesText[] = "Names of the responses, R of them, in the order of the rows of an array.";
inline constexpr char kPoseCoordinatesText[] = "Names of a pose's numbers, C of them, in order.";
inline constexpr char kUnitsText[] =
    "SI units (\"m\", \"rad\", \"1\") under \"errors\", \"responses\" and \"pose_coordinates\", in the order of the "
    "names.";

inline constexpr char kAtText[] = R"(at(pose)

The evaluator bound to one pose: C numbers in the order of pose_coordinates, m and rad. Raises InputError where the
mechanism does not reach it. A singular pose is taken; the status of its samples says so.)";

inline constexpr char kCallText[] = R"(evaluator(poses, errors, out=None, status=None, *, paired=False)

Responses at M poses (M, C), m and rad, of every pose with every sample:
errors (P, B) in C order, a row for each error: responses (M, R, B), status (M, B);
errors (P,), one sample: responses (M, R), status (M,).
With paired=True errors are (M, P), row m those of pose m: responses (M, R), status (M,).

As AtPose for everything else. Raises InputError for the first pose that the mechanism does not reach, before any is
solved.)";

inline constexpr char kAtPoseText[] = "An evaluator bound to one pose; Evaluator.at() makes it.";
inline constexpr char kPoseText[] = "The pose, m and rad.";

inline constexpr char kCallAtPoseText[] = R"(at_pose(errors, out=None, status=None)

Responses to B samples of P errors, SI. Three layouts of float64, each used where it stands:
errors (P, B) in C order, a row for each error: responses (R, B) in C order;
errors (B, P) in Fortran order, the same memory: responses (B, R) in Fortran order;
errors (P,), one sample: responses (R,).
A square array in C order has a row for each error.

out     takes the responses, in the shape and order above, and is returned; without it there is a new array.
status  takes how each sample ended: uint8, shape (B,), numbers of Status.

Samples that were not solved have NaN for all responses. Up to 1024 samples are solved in the arrays themselves, more in
blocks of 1024, each read into working memory and solved there. Other threads of Python run meanwhile; nobody may write
the arrays. Raises TypeError for another dtype, ValueError for another shape or order.)";

}  // namespace poesy::python
