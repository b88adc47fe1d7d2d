// A figure against its scale: every step of calibration ends in Good, Usable or Bad, and why.
#pragma once

#include <string>
#include <vector>

namespace livery {

enum class Grade { good, usable, bad };
std::string to_string(Grade grade);  ///< "Good", "Usable", "Bad"

/// Beyond `good` a value is usable, beyond `usable` it is bad; which way is beyond, their order
/// says. What is not finite is bad.
Grade grade_of(double value, double good, double usable);

struct GradedFigure {
    std::string name;     ///< "Valid pixels"
    std::string value;    ///< "97.3 %"
    std::string scale;    ///< "good over 95 %, usable over 85 %"; empty: for information
    std::string meaning;  ///< a sentence
    std::string fix;      ///< what helps when it is not good
    Grade grade = Grade::good;
};

/// A figure that is a share, in percent, with its scale in words.
GradedFigure graded_share(std::string name,
                          double value,
                          double good,
                          double usable,
                          std::string meaning,
                          std::string fix);

struct OverallGrade {
    Grade grade = Grade::good;
    std::string reason;  ///< the worst figure against its scale, in a sentence
    std::string fix;     ///< empty when it is good
};
/// The worst of them.
OverallGrade grade_of(const std::vector<GradedFigure>& figures);

}  // namespace livery
