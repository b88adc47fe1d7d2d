#include "studio/projector_words.h"

#include <algorithm>

namespace livery {

long count_of_warnings(const std::vector<SignalWarning>& list) {
    return std::count_if(list.begin(), list.end(), [](const SignalWarning& warning) {
        return warning.severity != SignalWarning::Severity::note;
    });
}

ProjectorWords projector_words(const ProjectorFacts& facts) {
    using enum ProjectorWords::Mood;
    if (facts.only_screen) {
        return {"dark: it is the only screen now",
                warning,
                "The projector's picture never covers the only screen that you have."};
    }
    if (facts.state == ProjectorScreen::State::off) {
        return {"Works without a projector: look at Photograph.", quiet, ""};
    }
    if (facts.state == ProjectorScreen::State::waiting_for_monitor) {
        return {"dark, comes back by itself",
                warning,
                facts.why_waiting + " Until then its picture is shown nowhere."};
    }
    if (facts.monitor_numbers) return {"showing the monitors' numbers", quiet, ""};
    if (facts.black) return {"black", warning, "B shows the picture again."};
    if (facts.signal_test) {
        return {"showing the test picture", warning, "Projector > Test picture ends it."};
    }
    if (facts.freezing) return {"keeps its picture while looks are frozen", quiet, ""};
    if (facts.voting) return {"showing the frozen frames of the vote", good, ""};
    if (facts.nudge) return {"showing the mock-up's lines", warning, "Esc ends it."};
    const bool behind = facts.shown != facts.wanted;
    if (facts.frozen) {
        return {behind ? "frozen: not what you work on" : "frozen",
                warning,
                "It keeps its picture. F shows the newest again."};
    }
    if (!facts.not_drawn.empty()) {
        return {"not this look: keeps the last picture", error, facts.not_drawn};
    }
    if (!facts.other_product.empty()) {
        return {"showing, corrected for another product", error, facts.other_product};
    }
    if (behind && facts.waited_s >= kUnspokenWait_s) return {"drawing…", quiet, ""};
    return {"showing", good, ""};
}

}  // namespace livery
