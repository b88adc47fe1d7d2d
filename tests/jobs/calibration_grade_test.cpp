// A calibration's figures against the scale that docs/calibration.md states.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "jobs/calibrate/calibration_check.h"

namespace livery {
namespace {

ColourCalibration good_calibration() {
    ColourCalibration calibration;
    calibration.valid_fraction = 0.97;
    calibration.additivity_error = 0.004;
    calibration.condition_p99 = 2.1;
    calibration.ambient_fraction = 0.002;
    return calibration;
}

TEST(Grade, IsGoodWhenEveryFigureIs) {
    const auto figures = grade_figures(good_calibration());
    EXPECT_EQ(figures.size(), 5u);
    const OverallGrade grade = grade_of(figures);
    EXPECT_EQ(grade.grade, Grade::good);
    EXPECT_TRUE(grade.fix.empty());
}

TEST(Grade, IsTheWorstFigures) {
    ColourCalibration calibration = good_calibration();
    calibration.ambient_fraction = 0.03;
    OverallGrade grade = grade_of(grade_figures(calibration));
    EXPECT_EQ(grade.grade, Grade::usable);
    EXPECT_EQ(grade.reason, "Room light 3.0 % (good under 1 %, usable under 5 %)");
    EXPECT_EQ(grade.fix, "Darken the room.");

    calibration.valid_fraction = 0.6;
    grade = grade_of(grade_figures(calibration));
    EXPECT_EQ(grade.grade, Grade::bad);
    EXPECT_EQ(grade.reason, "Valid pixels 60.0 % (good over 95 %, usable over 85 %)");
}

TEST(Grade, StandsAtEachLimit) {
    const auto graded = [](auto member, double value) {
        ColourCalibration calibration = good_calibration();
        calibration.*member = value;
        return grade_of(grade_figures(calibration)).grade;
    };
    const auto valid = &ColourCalibration::valid_fraction;
    EXPECT_EQ(graded(valid, 0.951), Grade::good);
    EXPECT_EQ(graded(valid, 0.95), Grade::usable);
    EXPECT_EQ(graded(valid, 0.85), Grade::bad);
    const auto additivity = &ColourCalibration::additivity_error;
    EXPECT_EQ(graded(additivity, 0.0199), Grade::good);
    EXPECT_EQ(graded(additivity, 0.02), Grade::usable);
    EXPECT_EQ(graded(additivity, 0.05), Grade::bad);
    const auto condition = &ColourCalibration::condition_p99;
    EXPECT_EQ(graded(condition, 2.9), Grade::good);
    EXPECT_EQ(graded(condition, 9.9), Grade::usable);
    EXPECT_EQ(graded(condition, 10.0), Grade::bad);
    for (const double none : {double(NAN), double(INFINITY)}) {
        EXPECT_EQ(graded(condition, none), Grade::bad);
        EXPECT_EQ(graded(valid, none), Grade::bad);
    }
}

TEST(Grade, CountsTheWorstResponse) {
    ColourCalibration calibration = good_calibration();
    calibration.response[1].largest_violation = 0.02;
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::usable);
    calibration.response[0].largest_violation = std::nan("");
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::bad);
    calibration.response[0].largest_violation = 0.0;
    calibration.response[2].largest_violation = 0.04;
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::bad);
}

TEST(Grade, CountsPredictionOnlyWhereSomethingWasPredicted) {
    ColourCalibration calibration = good_calibration();
    calibration.prediction_error_median = 0.5;
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::good);
    calibration.predicted_fraction = 0.08;
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::bad);
    calibration.prediction_error_median = 0.015;
    EXPECT_EQ(grade_of(grade_figures(calibration)).grade, Grade::good);
}

TEST(Grade, HasTheScaleOfTheDocs) {
    const std::string docs = read_text_file(LIVERY_SOURCE "/docs/calibration.md");
    for (const char* row : {"| `valid_fraction` | over 95% | over 85% |",
                            "| `prediction_error_median` | under 2% | under 10% |",
                            "| `additivity_error` | under 2% | under 5% |",
                            "| `condition_p99` | under 3 | under 10 |",
                            "| `ambient_fraction` | under 1% | under 5% |",
                            "| `largest_violation` of a response | under 1% | under 3% |"}) {
        EXPECT_NE(docs.find(row), std::string::npos) << row;
    }
}

}  // namespace
}  // namespace livery
