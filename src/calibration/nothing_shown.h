// A projector that shows nothing: asleep, frozen, or another screen's.
#pragma once

#include <limits>
#include <string>
#include <utility>

#include "core/error.h"

namespace livery {

/// No photograph shows that the projector followed. Those of its newest `pictures()` pictures need
/// not be of what they say: whoever kept them forgets them.
class NothingShown : public Refused {
  public:
    static constexpr int kAll = std::numeric_limits<int>::max();

    NothingShown(std::string why, std::string fix, int pictures)
        : Refused(std::move(why), std::move(fix)), pictures_(pictures) {}
    int pictures() const { return pictures_; }

  private:
    int pictures_;
};

}  // namespace livery
