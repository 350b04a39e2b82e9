#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/kinds/allocation/result.h"
#include "engine/stats/proportion.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::allocation {
namespace {

/// Expects equal numbers. NaN equals NaN.
void expect_same(std::span<const double> found, std::span<const double> expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_TRUE(found[k] == expected[k] || (std::isnan(found[k]) && std::isnan(expected[k]))) << k;
  }
}

void expect_same(const YieldVerdict& found, const YieldVerdict& expected) {
  EXPECT_EQ(found.decision, expected.decision);
  EXPECT_EQ(found.asked, expected.asked);
  EXPECT_EQ(found.conf_level, expected.conf_level);
  EXPECT_EQ(found.value, expected.value);
  EXPECT_EQ(found.ci_low, expected.ci_low);
  EXPECT_EQ(found.ci_high, expected.ci_high);
  EXPECT_EQ(found.machines, expected.machines);
  EXPECT_EQ(found.rejects, expected.rejects);
  EXPECT_EQ(found.unsolved, expected.unsolved);
}

class AllocationFile : public testing::Test {
 protected:
  AllocationFile() : path_(folder_.file("r.h5")), written_(example_.allocation()) { write(); }

  void write() const { example_.write_allocation(path_, written_); }

  StoredResult stored() const { return read_result(path_); }

  /// The message of the error when the file is read after its object `replaced` became a link to the object `by`. Empty
  /// if it was read without an error.
  std::string problem_with(const std::string& replaced, const std::string& by) const {
    write();
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    EXPECT_GE(H5Ldelete(file, replaced.c_str(), H5P_DEFAULT), 0) << replaced;
    EXPECT_GE(H5Lcreate_hard(file, by.c_str(), file, replaced.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0) << by;
    H5Fclose(file);
    try {
      stored();
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }

  /// The content of the exported table NAME.csv.
  std::string csv(const std::string& name) const {
    const std::string tables = folder_.file("tables");
    export_tables(stored(), tables);
    return test::read_bytes(tables + "/" + name + ".csv");
  }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_;
  Result written_;
};

TEST_F(AllocationFile, IsReadBackAsItWas) {
  const StoredResult result = stored();
  const Result& found = allocation_of(result);
  EXPECT_EQ(result.kind, "allocation");
  EXPECT_EQ(found.limit_use.lengths(), (std::array{std::size_t{2}, test::Example::kPoses}));
  EXPECT_EQ(found.part_names, written_.part_names);
  for (const auto member : {&Result::part_members, &Result::part_unit, &Result::chosen}) {
    EXPECT_EQ(found.*member, written_.*member);
  }
  for (const auto member : {&Result::tolerance, &Result::sigma, &Result::sigmas, &Result::shift, &Result::cost,
                            &Result::share, &Result::mean_square_share, &Result::coarser_yield}) {
    expect_same(found.*member, written_.*member);
  }
  for (const auto member : {&Result::multiplier, &Result::limit_use, &Result::deciding_share}) {
    expect_same(found.*member, written_.*member);
  }
  for (const auto member : {&Result::limit, &Result::saving, &Result::fixed_share})
    expect_same(found.*member, written_.*member);
  for (const auto member : {&Result::curve_yield, &Result::curve_factor}) EXPECT_EQ(found.*member, written_.*member);
  EXPECT_EQ(found.error_mean_square_share, written_.error_mean_square_share);
  EXPECT_EQ(found.stage_tolerance, written_.stage_tolerance);
  EXPECT_EQ(found.curve_yield_cost, written_.curve_yield_cost);
  EXPECT_EQ(found.curve_factor_cost, written_.curve_factor_cost);
  for (const auto member :
       {&Result::total_cost, &Result::lower_bound, &Result::gap, &Result::wanted_yield, &Result::confidence}) {
    EXPECT_EQ(found.*member, written_.*member);
  }
  EXPECT_EQ(found.bound, written_.bound);
  EXPECT_EQ(found.aim, Aim::least_cost);
  EXPECT_TRUE(found.calibrated);
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(AllocationFile, KeepsTheZonesOfADrawing) {
  using Texts = std::vector<std::string>;
  written_.part_names = {"rail.position", "rail.perpendicularity", "plate"};
  written_.part_unit = {{3}, Texts{"m", "m", "m"}};
  written_.chosen = {{3}, Texts{"", "", "IT7"}};
  written_.zone_feature = {{3}, Texts{"rail", "rail", ""}};
  written_.zone_limbs = {{3}, Texts{"1, 3", "1, 3", ""}};
  written_.zone_key = {{3}, Texts{"position", "perpendicularity", ""}};
  written_.zone_shape = {{3}, Texts{"cylinder", "cylinder", ""}};
  written_.zone_datums = {{3}, Texts{"A|B", "A", ""}};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  written_.zone_length = {{3}, {0.5, 0.5, kNone}};
  written_.zone_width = {{3}, {kNone, kNone, kNone}};
  written_.zone_inside = {{3}, {0.9779, 0.9889, kNone}};
  written_.zone_is_needed = {{3}, {1, 0, 1}};
  write();
  const StoredResult result = stored();
  const Result& found = allocation_of(result);
  for (const auto member :
       {&Result::zone_feature, &Result::zone_limbs, &Result::zone_key, &Result::zone_shape, &Result::zone_datums}) {
    EXPECT_EQ(found.*member, written_.*member);
  }
  for (const auto member : {&Result::zone_length, &Result::zone_width, &Result::zone_inside}) {
    expect_same(found.*member, written_.*member);
  }
  EXPECT_EQ(found.zone_is_needed, written_.zone_is_needed);
  EXPECT_EQ(csv("drawing"),
            "limbs,feature,symbol,sign,zone_mm,shape,datums,length_mm,cost,share_of_cost,share_of_mean_square,sigmas,"
            "inside,grade,remark,angle_deg\n"
            "\"1, 3\",rail,position,\u2316,0.01234,cylinder,A|B,500,2.5,0.25,0.5,3,0.9779,none,perpendicularity: not "
            "needed,\n"
            "none,plate,tolerance,\u00b1,0.025,interval,none,,0.5,0.05,0.125,3,,IT7,given,\n");
  written_.part_unit(2) = "rad";
  write();
  EXPECT_NE(csv("drawing").find("none,plate,tolerance,\u00b1,,interval,none,,0.5,0.05,0.125,3,,IT7,given,0.001432\n"),
            std::string::npos);
  EXPECT_NE(problem_with("/allocation/zone_key", "/allocation/zone_feature").find("unknown zone"), std::string::npos);
}

TEST_F(AllocationFile, KeepsTheWayAndTheCertificate) {
  const StoredResult result = stored();
  const Result& found = allocation_of(result);
  ASSERT_EQ(found.stages.size(), 2u);
  EXPECT_EQ(found.stages[1].name, "scaled to the yield");
  EXPECT_EQ(found.stages[1].cost, 10.0);
  EXPECT_EQ(found.stages[1].lower_bound, 9.995);
  EXPECT_EQ(found.stages[1].rms_share, 0.3);
  EXPECT_EQ(found.stages[1].machines, 20000u);
  EXPECT_EQ(found.stages[1].rejects, 48u);
  for (const auto member : {&Result::design_machines, &Result::design_rejects, &Result::design_most,
                            &Result::certificate_seed, &Result::certificate_most}) {
    EXPECT_EQ(found.*member, written_.*member);
  }
  expect_same(found.certificate, written_.certificate);
  EXPECT_EQ(found.certificate_study, written_.certificate_study);
  EXPECT_EQ(found.failures, written_.failures);
  EXPECT_EQ(found.total().by_status, written_.total().by_status);
  ASSERT_TRUE(result.verdicts && result.verdicts->yield);
  EXPECT_EQ(result.verdicts->judge, Judge::yield);
  expect_same(*result.verdicts->yield, written_.certificate);
  EXPECT_TRUE(result.failures.empty()) << "'poesy replay' would draw other errors than the certificate's";
}

TEST_F(AllocationFile, KeepsEveryAimAndDecision) {
  using enum YieldVerdict::Decision;
  for (const Aim aim : {Aim::least_cost, Aim::equal_effect, Aim::equal_tolerance, Aim::common_factor}) {
    for (const auto decision : {not_asked, kept, not_kept, undecided}) {
      written_.aim = aim;
      written_.certificate.decision = decision;
      written_.calibrated = decision == kept;
      write();
      const StoredResult result = stored();
      EXPECT_EQ(allocation_of(result).aim, aim);
      EXPECT_EQ(allocation_of(result).certificate.decision, decision);
      EXPECT_EQ(allocation_of(result).calibrated, decision == kept);
    }
  }
}

TEST_F(AllocationFile, MayHaveNeitherCostsNorCurvesNorFailures) {
  written_.total_cost = written_.lower_bound = std::nan("");
  written_.curve_yield = written_.curve_factor = {};
  written_.curve_yield_cost = {};
  written_.curve_factor_cost = {};
  written_.failures.clear();
  write();
  const StoredResult result = stored();
  EXPECT_TRUE(std::isnan(allocation_of(result).total_cost));
  EXPECT_TRUE(allocation_of(result).curve_yield.empty());
  EXPECT_TRUE(allocation_of(result).failures.empty());
}

TEST_F(AllocationFile, SaysWhatFollowsForOtherPrograms) {
  const h5::File file = h5::File::open(path_);
  const auto number = [&](const char* name) { return file.attribute<double>("/allocation", name).at(0); };
  EXPECT_EQ(number("cost"), 10.0);
  EXPECT_EQ(number("gap"), 0.005);
  EXPECT_EQ(number("yield"), written_.certificate.value);
  EXPECT_EQ(number("yield_ci_low"), written_.certificate.ci_low);
  EXPECT_EQ(number("yield_ci_high"), written_.certificate.ci_high);
  EXPECT_EQ(number("certified"), 1.0);
  EXPECT_EQ(file.shape("/allocation/tolerance"), h5::Shape{3});
  EXPECT_EQ(file.shape("/allocation/multiplier"), (h5::Shape{2, 4}));
  EXPECT_EQ(file.read<std::string>("/allocation/part"), written_.part_names);
  EXPECT_EQ(file.read<double>("/allocation/certificate/lower_bound").at(0), proportion_at_least(147640, 148000, 0.95));
}

TEST_F(AllocationFile, RefusesWrongShapes) {
  const std::set<std::string> axes{"part", "factor", "response", "pose", "stage", "curve_yield", "curve_factor"};
  std::vector<std::string> datasets{"/allocation/certificate_study"};
  {
    const h5::File file = h5::File::open(path_);
    for (const std::string group :
         {"/allocation", "/allocation/stages", "/allocation/curve", "/allocation/certificate"}) {
      for (const std::string& name : file.children(group)) {
        const std::string path = group + "/" + name;
        if (!file.is_group(path) && !axes.contains(name)) datasets.push_back(path);
      }
    }
  }
  EXPECT_GT(datasets.size(), 36u);
  for (const std::string& path : datasets) {
    const bool large = path.ends_with("multiplier") || path.ends_with("limit_use") || path.ends_with("deciding_share");
    EXPECT_NE(
        problem_with(path, large ? "/allocation/limit" : "/allocation/multiplier").find("the shape it should have"),
        std::string::npos)
        << path;
  }
}

TEST_F(AllocationFile, RefusesWhatNoCertificateHas) {
  EXPECT_NE(problem_with("/allocation/certificate/decision", "/allocation/certificate_study").find("unknown decision"),
            std::string::npos);
  EXPECT_NE(problem_with("/allocation/certificate/rejects", "/allocation/certificate/seed").find("no certificate has"),
            std::string::npos);
  written_.bound(2) = 5;
  write();
  EXPECT_THROW(stored(), FileError);
}

TEST_F(AllocationFile, IsExportedAsTheDrawingHasIt) {
  EXPECT_EQ(
      csv("allocation"),
      "part,tolerance [m or rad],tolerance [mm or deg],sigma [m or rad],sigma [mm or deg],shift [m or rad],"
      "shift [mm or deg],sigmas,cost,share,mean_square_share,bound,coarser_yield,unit,chosen,errors\n"
      "bars,1.23456789e-05,0.0123456789,4.11522e-06,0.004115219999999999,0,0,3,2.5,0.25,0.5,0,0.9965,m,none,delta_1 "
      "delta_2\n"
      "hinge,0.0017453292519943296,0.1,0.00058177641733144,0.03333333333333315,0,0,3,7,0.7,0.375,2,0.9971,rad,"
      "grinding,epsilon_1\n"
      "plate,2.5e-05,0.025,7.5e-06,0.0075,2.5e-06,0.0025,3,0.5,0.05,0.125,3,NaN,m,IT7,delta_3\n");
  EXPECT_EQ(csv("allocation_errors"), "factor,mean_square_share\nepsilon_1,0.375\ndelta_1,0.45\n");
  EXPECT_EQ(
      csv("allocation_limits"),
      "response,limit,saving,fixed_share,deciding_share,largest_limit_use,largest_limit_use_pose,largest_multiplier,"
      "largest_multiplier_pose,unit\nlinear_deformation,3e-05,0.09,0.25,1,1,3,200000,2,m\n");
  EXPECT_EQ(
      csv("allocation_poses"),
      "pose,limit_use_linear_deformation,multiplier_linear_deformation [cost/m],deciding_share_linear_deformation\n"
      "0,0.25,0,0\n1,0.5,0,0.25\n2,0.75,200000,0.5\n3,1,100000,0.25\n");
}

TEST_F(AllocationFile, IsExportedWithItsWayAndItsCertificate) {
  EXPECT_EQ(csv("allocation_stages"),
            "stage,cost,lower_bound,rms_share,machines,rejects\n"
            "linear,9,8.75,0.3333,0,0\nscaled to the yield,10,9.995,0.3,20000,48\n");
  EXPECT_EQ(csv("allocation_curves"),
            "curve,at,cost\nyield,0.99,8\nyield,0.9973,10\nyield,0.999,12.5\n"
            "factor of limits,0.5,20\nfactor of limits,1,10\n");
  const std::string certificate = csv("allocation_certificate");
  EXPECT_TRUE(
      certificate.starts_with("decision,asked,conf_level,seed,machines,rejects,unsolved,most_rejects,yield,"
                              "ci_low,ci_high,lower_bound,design_machines,design_rejects,design_most\n"
                              "kept,0.9973,0.95,12345678901234567890,148000,360,2,366,"))
      << "a seed has 64 bits, a double has 53";
  EXPECT_TRUE(csv("not_converged").starts_with("pose,not_converged,"));
  EXPECT_EQ(csv("failures"), "factor,pose,sample,status\nall,2,7,3\n");
  EXPECT_TRUE(csv("factors").starts_with("factor,start_sigma [rad or m],"));
}

}  // namespace
}  // namespace poesy::allocation
