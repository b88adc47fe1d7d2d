#include "evaluation/report/round_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "core/image_io.h"
#include "evaluation/statistics/figures.h"
#include "evaluation/statistics/pairs.h"

namespace livery {

namespace {

/// As a sentence of its own: the words of a verdict may follow a colon.
std::string sentence(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') {
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    }
    if (!text.empty() && text.back() != '.') text += '.';
    return text;
}

std::string counted(int count, const std::string& one, const std::string& many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

class ReportBuilder {
  public:
    explicit ReportBuilder(const RoundReportSource& source)
        : source_(source),
          statistics_(source.statistics),
          rows_(chart_rows(source.statistics, source.names)) {}

    ReportDocument made() {
        document_.title = title();
        document_.subtitle = subtitle();
        document_.made_by = source_.program;
        document_.made_at = source_.made_at;
        add_duel();
        add_verdict();
        add_votes();
        if (statistics_.evaluators > 0) add_certainty();
        add_power();
        add_scales();
        add_designs();
        add_showing();
        add_record();
        return std::move(document_);
    }

  private:
    void heading(const std::string& text) { document_.blocks.emplace_back(ReportHeading{2, text}); }
    void say(const std::string& text, ParagraphRole role = ParagraphRole::body) {
        document_.blocks.emplace_back(ReportParagraph{text, role});
    }
    template <typename Block>
    void add(Block block) {
        document_.blocks.emplace_back(std::move(block));
    }

    std::string title() const {
        if (!source_.details.title.empty()) return source_.details.title;
        const int designs = statistics_.counts.designs();
        return source_.record
                   ? fmt::format(
                         "Round {}: {} designs under vote", source_.record->round.id, designs)
                   : fmt::format("A vote on {} designs", designs);
    }

    std::string subtitle() const {
        std::string text = source_.record ? source_.record->round.created.substr(0, 10)
                                          : source_.made_at.substr(0, 10);
        text += ", " + counted(statistics_.evaluators, "ballot", "ballots") + " on " +
                counted(statistics_.counts.designs(), "design", "designs");
        if (source_.record) {
            text += fmt::format(", round {} of {}", source_.record->round.id, source_.record->file);
        }
        return text;
    }

    std::string asked() const {
        std::string text = "Asked: ";
        text += source_.details.question.empty() ? "which design is best, and which second best"
                                                 : source_.details.question;
        text += source_.details.question.ends_with('?') ? " " : ". ";
        const bool least =
            source_.record ? source_.record->round.asks_least : statistics_.counts.has_least();
        text += fmt::format("Each evaluator named one best and one second best look{}, ",
                            !least                       ? ""
                            : source_.record.has_value() ? ", and could name the least liked"
                                                         : ", and the least liked");
        text += source_.record ? "under codes that say nothing of what they stand for; nothing was "
                                 "counted before the round was locked."
                               : "as the typed counts have it.";
        if (least && !statistics_.counts.has_least() && statistics_.evaluators > 0) {
            text += " Not every ballot names a least, so it is left out of all figures.";
        }
        return text;
    }

    void add_verdict() {
        if (!source_.details.note.empty()) say(source_.details.note);
        say(sentence(statistics_.words), ParagraphRole::lead);
        say(asked());
        if (statistics_.evaluators == 0) return;
        const bool preference = statistics_.friedman_p <= 0.05;
        std::string text = fmt::format(
            "Any preference at all? {}: were all liked alike, ballots as far from even as these "
            "would come about with p {} ({}).",
            preference ? "Yes, at 5%" : "None is shown",
            statistics_.friedman_p < 0.0001 ? p_text(statistics_.friedman_p)
                                            : "= " + p_text(statistics_.friedman_p),
            statistics_.friedman_method == Method::exact ? "exact" : "drawn");
        const Verdict& verdict = statistics_.verdict;
        if (preference && verdict.leader >= 0 && statistics_.evaluators > 1) {
            text += fmt::format(" {} would be first in {} of rounds of as many other evaluators.",
                                label(verdict.leader),
                                percent_text(verdict.win_probability));
        }
        say(text);
    }

    void add_votes() {
        heading("The votes");
        if (statistics_.evaluators > 0) add(votes_chart(statistics_, rows_));
        add(votes_table(statistics_, rows_));
    }

    void add_certainty() {
        heading("How sure it is");
        add(rank_sum_chart(statistics_, rows_));
        add(worths_chart(statistics_, rows_));
        add(pairs_chart(statistics_, rows_));
        add(first_chart(statistics_, rows_));
        add(tests_table(statistics_, rows_));
        add(worths_table(statistics_, rows_));
        add(pairs_table(statistics_, rows_));
    }

    void add_duel() {
        if (!source_.record || !source_.record->duel) return;
        const DuelRecord& duel = *source_.record->duel;
        heading("The duel");
        say(sentence(duel.words), ParagraphRole::lead);
        say(
            fmt::format("This round is one of {} blind repeats of the same two looks, each under "
                        "codes and in an order of its own. They are a test by themselves: the "
                        "round that it follows{} is no part of its figures.",
                        duel.series.repeats,
                        duel.series.follows > 0 ? fmt::format(", {},", duel.series.follows) : ""));
        add(duel_repeats_table(duel));
        add(duel_tests_table(duel));
    }

    void add_power() {
        const auto curve = power_curve(statistics_);
        if (curve.empty()) return;
        heading("If it is to be known more surely");
        add(power_chart(statistics_, curve, rows_));
        say("This round may not be topped up. To add voters to it until it tells is to look again "
            "and again, which finds a difference sooner or later where there is none; that would "
            "ask for a correction that is not made here. A fresh round, planned in its size and "
            "counted by itself, needs none.");
        add(power_table(statistics_, curve));
    }

    void add_scales() {
        const ScaleStatistics& scales = source_.scales;
        if (scales.scales.empty()) return;
        heading("Where the looks lie between words");
        say(
            fmt::format("After the ballot each look could be placed in seven steps between two "
                        "words, from 1 at the first to 7 at the second; {} did so at least once.",
                        counted(scales.evaluators, "evaluator", "evaluators")));
        for (const ScaleFigures& figures : scales.scales) say(sentence(figures.words));
        add(scale_means_table(scales, rows_));
        add(scale_tests_table(scales));
    }

    void add_designs() {
        heading("The designs");
        ReportPictures pictures;
        for (std::size_t k = 0; k < source_.names.size(); ++k) {
            const LookDetails* look = look_of(k);
            if (!look || look->picture.empty()) continue;
            pictures.pictures.push_back(
                {fmt::format("{}, shown as {}", rows_.labels[k], look->code),
                 fmt::format("{} as it looks to the audience", rows_.labels[k]),
                 read_report_picture(source_.details.folder / look->picture)});
        }
        if (!pictures.pictures.empty()) add(std::move(pictures));
        add(designs_table(source_, rows_));
    }

    void add_showing() {
        heading("How it was shown");
        const std::string id = source_.record ? source_.record->round.calibration_id : "";
        ReportTable table{"Calibration", {{"What", false}, {"Figure", false}}, {}};
        table.rows.push_back({"Id",
                              !id.empty()      ? id
                              : source_.record ? "none: the looks were shown uncorrected"
                                               : kNotRecorded});
        for (const auto& [name, value] : source_.calibration) table.rows.push_back({name, value});
        if (source_.calibration.empty() && !id.empty()) {
            table.rows.push_back({"Its figures", kNotRecorded});
        }
        add(std::move(table));
        add_eye();
        ReportTable showings = showings_table(source_);
        if (showings.rows.empty()) {
            say(std::string("Who saw which order, and when: ") + kNotRecorded + ".");
        } else {
            add(std::move(showings));
        }
    }

    void add_eye() {
        const auto& eye = source_.details.eye;
        if (!eye)
            return say(std::string("Whose eye highlights were drawn for: ") + kNotRecorded + ".");
        say(
            fmt::format("Highlights were drawn for one eye, {}, at x {:.0f}, y {:.0f}, z {:.0f} mm "
                        "of the mock-up's frame (y is up).",
                        eye->of,
                        eye->eye_mm.x,
                        eye->eye_mm.y,
                        eye->eye_mm.z));
        if (!eye->seats.empty()) add(seats_table(source_, rows_));
    }

    void add_record() {
        heading("The record");
        add(record_table(source_));
        say("Verdict: a clear winner needs Friedman's exact p of at most .05, a 95% interval "
            "against "
            "each other design without 1, the first place in 85% of rounds of other evaluators, "
            "and "
            "a likelihood ratio that passes by its own law; leading, the first place in two of "
            "three. Sources: Friedman 1937; Kendall and Babington Smith 1939; Wilson 1927; Luce "
            "1959 and Plackett 1975; Efron 1979; Krippendorff 2004; Turner, van Etten, Firth and "
            "Kosmidis 2020 for the ghost.",
            ParagraphRole::note);
    }

    std::string label(int design) const { return rows_.labels[static_cast<std::size_t>(design)]; }

    const LookDetails* look_of(std::size_t design) const {
        if (!source_.record || design >= source_.record->round.codes.size()) return nullptr;
        const auto& looks = source_.details.looks;
        const auto found = std::find_if(looks.begin(), looks.end(), [&](const LookDetails& look) {
            return look.code == source_.record->round.codes[design];
        });
        return found == looks.end() ? nullptr : &*found;
    }

    const RoundReportSource& source_;
    const VoteStatistics& statistics_;
    ChartRows rows_;
    ReportDocument document_;
};

}  // namespace

ChartRows chart_rows(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    ChartRows rows;
    rows.order.resize(names.size());
    std::iota(rows.order.begin(), rows.order.end(), 0);
    std::stable_sort(rows.order.begin(), rows.order.end(), [&](int a, int b) {
        return statistics.rank_sums[static_cast<std::size_t>(a)] <
               statistics.rank_sums[static_cast<std::size_t>(b)];
    });
    const bool own_letters = names == default_names(static_cast<int>(names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::string letter(1, static_cast<char>('A' + k));
        rows.keys.push_back(own_letters ? names[k] : letter);
        rows.labels.push_back(own_letters ? names[k] : letter + " " + names[k]);
    }
    return rows;
}

std::vector<VoteStatistics::Power> power_curve(const VoteStatistics& statistics,
                                               std::size_t rounds) {
    std::vector<VoteStatistics::Power> curve = statistics.power;
    if (curve.empty()) return curve;
    constexpr int steps = 7;
    const int needed = statistics.evaluators_needed.value_or(0);
    const int most = std::clamp(needed + needed / 5,
                                curve.back().evaluators,
                                std::max(curve.back().evaluators, kMostEvaluators));
    const BallotLaw law = ballot_law(statistics.worths, statistics.counts.has_least());
    for (int step = 1; step <= steps; ++step) {
        const int evaluators = std::max(2, most * step / steps);
        // Beside a number that is there already another one says nothing.
        const bool near = std::any_of(curve.begin(), curve.end(), [&](const auto& point) {
            return std::abs(point.evaluators - evaluators) * 2 * steps < most;
        });
        if (near) continue;
        curve.push_back({evaluators,
                         simulated_power(law,
                                         evaluators,
                                         statistics.verdict.leader,
                                         statistics.verdict.rival,
                                         statistics.seed,
                                         rounds)});
    }
    std::sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) {
        return a.evaluators < b.evaluators;
    });
    return curve;
}

VoteStatistics round_statistics(const ClosedRound& closed, std::uint64_t seed) {
    const std::vector<std::string>& designs = closed.round.designs;
    return vote_statistics(
        counts_of(closed.ballots, static_cast<int>(designs.size()), closed.all_name_least),
        designs,
        seed,
        &closed.ballots);
}

RoundReportSource report_source(ClosedRound closed, std::uint64_t seed) {
    RoundReportSource source;
    source.names = closed.round.designs;
    source.statistics = round_statistics(closed, seed);
    source.scales = scale_statistics(closed.answers, closed.round.scales, source.names, seed);
    source.record = std::move(closed);
    return source;
}

RoundReportSource round_report_source(const std::filesystem::path& ballots,
                                      std::optional<int> id,
                                      std::uint64_t seed) {
    RoundReportSource source = report_source(read_closed_round(ballots, id, seed), seed);
    const Round& round = source.record->round;
    source.details =
        read_round_details(round_details_file(ballots, round.id), round.id, round.codes);
    return source;
}

ReportDocument round_report(const RoundReportSource& source) {
    return ReportBuilder(source).made();
}

Image8 read_report_picture(const std::filesystem::path& file, int widest) {
    const ImageFile read = read_image(file);
    if (read.floating_point) {
        throw FileError(file, "", "floating-point values", "a picture to look at, such as a PNG");
    }
    const ImageF& image = read.image;
    const int width = std::min(image.width, widest);
    const int height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    Image8 small(width, height, 3);
    // The mean over what each pixel covers, of the values as they are: for thumbnails good enough.
    const auto bounds = [](int at, int count, int of) {
        const auto from = static_cast<int>(static_cast<std::int64_t>(at) * of / count);
        const auto to = static_cast<int>(static_cast<std::int64_t>(at + 1) * of / count);
        return std::pair{from, std::max(from + 1, to)};
    };
    for (int y = 0; y < height; ++y) {
        const auto [top, bottom] = bounds(y, height, image.height);
        for (int x = 0; x < width; ++x) {
            const auto [left, right] = bounds(x, width, image.width);
            for (int c = 0; c < 3; ++c) {
                const int channel = image.channels >= 3 ? c : 0;
                double sum = 0.0;
                for (int row = top; row < bottom; ++row) {
                    for (int column = left; column < right; ++column) {
                        sum += static_cast<double>(image.at(column, row, channel));
                    }
                }
                const double mean = sum / ((bottom - top) * (right - left)) / read.full_scale;
                small.at(x, y, c) =
                    static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(mean, 0.0, 1.0)));
            }
        }
    }
    return small;
}

}  // namespace livery
