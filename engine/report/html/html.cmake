# The report as a part of poesy_report.
target_sources(poesy_report PRIVATE
               report/html/comparison.cpp report/html/comparison_page.cpp report/html/comparison_values.cpp
               report/html/figures.cpp report/html/figures_json.cpp report/html/glossary.cpp
               report/html/html_table.cpp report/html/markup.cpp report/html/outcomes.cpp report/html/page.cpp
               report/html/parts.cpp report/html/pose_order.cpp report/html/report.cpp
               report/html/section_tolerances.cpp report/html/sections_certainty.cpp report/html/sections_coupling.cpp
               report/html/sections_evaluation.cpp report/html/sections_identification.cpp
               report/html/sections_monte_carlo.cpp report/html/sections_of_errors.cpp
               report/html/sections_sensitivity.cpp report/html/study_facts.cpp report/html/warnings.cpp
               report/html/what_was_run.cpp)
