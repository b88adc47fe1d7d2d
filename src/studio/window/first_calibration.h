// The simulated bench is calibrated by itself for whoever has no calibration yet.
#pragma once

namespace livery {

struct Shell;

/// A new session of a product that was calibrated on this bench before takes that calibration; if
/// there is none, it is made after the first picture.
void find_first_calibration(Shell& shell);
/// A newcomer has no calibration: the simulated bench is measured as soon as there is a first
/// picture, while everything works uncorrected.
void start_first_calibration(Shell& shell);
/// Loads what a calibration that has ended made, whoever asked for it, and tells why there is none.
void take_calibration(Shell& shell);

}  // namespace livery
