// How a round's eye is written. Include only where core/json.h may be.
#pragma once

#include "core/json.h"
#include "evaluation/report/round_eye.h"

namespace livery {

Json json_of(const RoundEye& eye);

}  // namespace livery
