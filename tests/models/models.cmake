poesy_test(lie_test LABELS property SOURCES models/lie/so3_test.cpp models/lie/se3_test.cpp LINKS poesy_models)
poesy_test(chain_test LABELS property SOURCES models/chain/limb_test.cpp models/chain/deformation_solver_test.cpp models/chain/first_order_test.cpp
           models/chain/metric_test.cpp models/chain/passive_condition_test.cpp models/chain/separation_test.cpp
           LINKS poesy_models)
poesy_test(trace_test LABELS unit SOURCES models/trace_test.cpp LINKS poesy_models)
poesy_test(sketch_test LABELS property SOURCES models/sketch_test.cpp LINKS poesy_models DATA)
poesy_test(two_upr_rpu_test LABELS unit
           SOURCES models/two_upr_rpu/errors_test.cpp models/two_upr_rpu/kinematics_test.cpp
                   models/two_upr_rpu/model_test.cpp
           LINKS poesy_models nlohmann_json::nlohmann_json DATA)
poesy_test(three_prs_test LABELS unit
           SOURCES models/three_prs/calibrated_test.cpp models/three_prs/closure_branch_test.cpp models/three_prs/closure_kernel_test.cpp models/three_prs/closure_lanes_test.cpp
                   models/three_prs/errors_test.cpp models/three_prs/first_order_kernel_test.cpp
                   models/three_prs/kinematics_test.cpp models/three_prs/machine_test.cpp
                   models/three_prs/model_test.cpp models/three_prs/separation_test.cpp
                   models/three_prs/trajectory_test.cpp
           LINKS poesy_models poesy_kinds nlohmann_json::nlohmann_json DATA)
poesy_test(three_prs_coupling_test LABELS property SOURCES models/three_prs/coupling_test.cpp LINKS poesy_kinds poesy_models)
# Of every mechanism in the registry, whatever it is.
poesy_test(registry_test LABELS property SOURCES models/registry_test.cpp LINKS poesy_kinds poesy_models)
poesy_test(file_model_test LABELS unit SOURCES models/file/errors_test.cpp models/file/model_test.cpp
                   models/file/separation_test.cpp
           LINKS poesy_models nlohmann_json::nlohmann_json DATA ALONE)
poesy_test(compiled_test LABELS regression SOURCES models/file/compiled_test.cpp models/file/nategh_agheli_test.cpp
           LINKS poesy_models DATA)
poesy_test(mechanism_file_test LABELS property
           SOURCES models/file/drawing_gaps_test.cpp models/file/expression_test.cpp models/file/features_test.cpp models/file/frames_test.cpp models/file/general_test.cpp
                   models/file/mechanism_file_test.cpp
                   models/file/mobility_test.cpp models/file/oracle_test.cpp models/file/rounding_test.cpp
                   models/file/tracking_test.cpp
                   models/file/pose_tracker_test.cpp
           LINKS poesy_models nlohmann_json::nlohmann_json DATA ALONE)
poesy_test(assembly_oracle_test LABELS unit SOURCES models/assembly/closure_test.cpp models/assembly/oracle_test.cpp
           LINKS poesy_models nlohmann_json::nlohmann_json DATA)
poesy_test(assembly_properties_test LABELS property
           SOURCES models/assembly/balance_test.cpp models/assembly/block_solver_test.cpp
                   models/assembly/calibration_test.cpp
                   models/assembly/closed_forms_test.cpp models/assembly/continuation_test.cpp
                   models/assembly/cuts_test.cpp
                   models/assembly/loops_test.cpp
                   models/assembly/properties_test.cpp models/assembly/separation_test.cpp models/assembly/starts_test.cpp
                   models/assembly/unbranched_test.cpp
           LINKS poesy_models DATA)
poesy_test(platform_points_test LABELS unit SOURCES models/file/platform_points_test.cpp LINKS poesy_models DATA)
poesy_test(branched_file_test LABELS property SOURCES models/file/branched_file_test.cpp LINKS poesy_models DATA)
poesy_test(file_poses_test LABELS property SOURCES models/file/charts_test.cpp models/file/workspace_test.cpp
           LINKS poesy_models DATA)
