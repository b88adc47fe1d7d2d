#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "evaluation/report/round_report.h"
#include "evaluation/report/vector_drawing.h"
#include "evaluation/statistics/figures.h"

namespace livery {

namespace {

std::size_t index_of(int design) { return static_cast<std::size_t>(design); }

/// A part of a bar with its number, where there is room for it.
void draw_part(VectorDrawing& drawing,
               double left,
               double right,
               double top,
               double height,
               int count,
               DrawingColour fill,
               bool hatched) {
    if (count == 0) return;
    DrawnShape box = drawn_box(left, top, right - left, height);
    box.fill = hatched ? kPaperColour : fill;
    drawing.add(box);
    if (hatched) {
        hatch(drawing, left, top, right - left, height, fill);
        box.fill.reset();
        box.stroke = fill;
        box.width = 0.8;
        drawing.add(box);
    }
    const std::string text = std::to_string(count);
    const double width = estimated_width(text, kFigureSize, true);
    if (width + 4.0 > right - left) return;
    const double middle = 0.5 * (left + right), baseline = top + 0.5 * height + 3.1;
    if (hatched) {
        DrawnShape ground =
            drawn_box(middle - 0.5 * width - 2.0, baseline - 8.5, width + 4.0, 11.0);
        ground.fill = kPaperColour;
        drawing.add(ground);
    }
    drawing.add(DrawnText{{middle, baseline},
                          text,
                          kFigureSize,
                          TextAnchor::middle,
                          fill == kStrongColour ? kPaperColour : kInkColour,
                          true});
}

std::string votes_in_words(const VoteCounts& counts, const ChartRows& rows) {
    std::string text;
    for (const int design : rows.order) {
        const std::size_t k = index_of(design);
        text += fmt::format("{}{}: best {}, second best {}",
                            text.empty() ? "" : "; ",
                            rows.labels[k],
                            counts.best[k],
                            counts.second[k]);
        if (counts.has_least()) text += fmt::format(", least {}", counts.least[k]);
    }
    return text + ".";
}

/// What a row comes to, at its right end and for who does not see the chart.
void add_figures(ReportChart& chart,
                 const ChartRows& rows,
                 std::size_t row,
                 double y,
                 const std::string& figures) {
    chart.drawing.add(
        DrawnText{{chart.drawing.width, y + 3.1}, figures, kFigureSize, TextAnchor::end});
    chart.alternative += fmt::format("{}: {}{}",
                                     rows.labels[index_of(rows.order[row])],
                                     figures,
                                     row + 1 < rows.order.size() ? "; " : ".");
}

/// A dot of a row's value, hollow where its design is told from the leader.
void add_dot(VectorDrawing& drawing, DrawingPoint at, bool told) {
    DrawnDot dot{at, 4.6, kStrongColour};
    if (told) dot = {at, 4.5, kPaperColour, kStrongColour, 1.8};
    drawing.add(dot);
}

}  // namespace

ReportChart votes_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    const VoteCounts& counts = statistics.counts;
    ReportChart chart{"How often each design was named", votes_in_words(counts, rows), "", {}};
    VectorDrawing& drawing = chart.drawing;
    const ChartFrame frame = begin_rows(drawing, rows, 22.0, 8.0);
    double x = frame.left;
    x = legend_entry(drawing, x, 9.0, "best", kStrongColour, false);
    x = legend_entry(drawing, x, 9.0, "second best", kMiddleColour, false);
    if (counts.has_least()) legend_entry(drawing, x, 9.0, "least", kWarmColour, true);
    int longest = 1;
    for (std::size_t k = 0; k < counts.best.size(); ++k) {
        longest = std::max(
            longest,
            counts.best[k] + counts.second[k] + (counts.has_least() ? counts.least[k] : 0));
    }
    const ChartAxis axis{0.0, static_cast<double>(longest), frame.left, frame.right};
    draw_axis(drawing,
              frame,
              axis,
              linear_ticks(0.0, longest, 10, true),
              fmt::format("ballots that name it, of {}", statistics.evaluators));
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const std::size_t k = index_of(rows.order[row]);
        const double height = 0.62 * frame.row_height, top = frame.middle(row) - 0.5 * height;
        int from = 0;
        const auto part = [&](int count, DrawingColour fill, bool hatched) {
            draw_part(
                drawing, axis.at(from), axis.at(from + count), top, height, count, fill, hatched);
            from += count;
        };
        part(counts.best[k], kStrongColour, false);
        part(counts.second[k], kMiddleColour, false);
        if (counts.has_least()) part(counts.least[k], kWarmColour, true);
    }
    chart.note = "Each ballot names one design as best and another as second best" +
                 std::string(counts.has_least() ? ", and one as the least." : ".") +
                 " Designs stand in the order of their rank sums, here and in all charts.";
    return chart;
}

ReportChart rank_sum_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportChart chart{"Rank sums", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const ChartFrame frame = begin_rows(drawing, rows, 6.0, 44.0);
    const double designs = static_cast<double>(rows.order.size());
    const double evaluators = std::max(1, statistics.evaluators);
    const ChartAxis axis{evaluators, designs * evaluators, frame.left + 8.0, frame.right - 4.0};
    draw_axis(drawing,
              frame,
              axis,
              linear_ticks(axis.low, axis.high, 9, true),
              "rank sum; the further left, the more liked");
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const std::size_t k = index_of(rows.order[row]);
        const double sum = statistics.rank_sums[k];
        const bool told = told_from_leader(statistics.verdict, rows.order[row]);
        drawing.add(DrawnLine{
            {frame.left, frame.middle(row)}, {axis.at(sum), frame.middle(row)}, kGridColour, 1.0});
        add_dot(drawing, {axis.at(sum), frame.middle(row)}, told);
        add_figures(chart, rows, row, frame.middle(row), fmt::format("{:.1f}", sum));
    }
    chart.note =
        statistics.counts.has_least()
            ? "1 for best, 2 for second best, the last place for the least and the mean of "
              "the places left for each other, added up over the ballots. "
            : "1 for best, 2 for second best and the mean of the places left for each "
              "other, added up over the ballots. ";
    chart.note += statistics.verdict.kind == VerdictKind::no_preference
                      ? "The ballots as a whole show no preference (Friedman), so nothing is told "
                        "apart, however far apart two sums lie."
                      : "Hollow marks are told from the first, as the verdict has it.";
    return chart;
}

ReportChart first_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportChart chart{"Who would be first among other evaluators", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const ChartFrame frame = begin_rows(drawing, rows, 6.0, 92.0);
    const ChartAxis axis{0.0, 1.0, frame.left, frame.right};
    std::vector<ChartTick> ticks;
    for (const int percent : {0, 25, 50, 75, 100}) {
        ticks.push_back({percent / 100.0, fmt::format("{}%", percent)});
    }
    draw_axis(drawing, frame, axis, ticks, "chance to be first by rank sums");
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const std::size_t k = index_of(rows.order[row]);
        const double chance = statistics.predicted.first[k];
        const double height = 0.5 * frame.row_height;
        DrawnShape bar = drawn_box(
            frame.left, frame.middle(row) - 0.5 * height, axis.at(chance) - frame.left, height);
        bar.fill = kMiddleColour;
        drawing.add(bar);
        add_figures(chart, rows, row, frame.middle(row), percent_text(chance));
    }
    chart.note = fmt::format(
        "Of rounds of {} other evaluators ({}), with what these ballots leave open of how well the "
        "designs are liked. Where several are first, they share it. Of designs that are liked "
        "alike "
        "it says too much of the one that happens to lead.",
        statistics.evaluators,
        method_text(statistics.predicted.method, statistics.predicted.cases));
    return chart;
}

namespace {

/// Odds of a over b, whichever way round the pair stands.
struct PairOdds {
    double odds = 1.0, low = 1.0, high = 1.0, p = 1.0;
    bool excludes_one() const { return low > 1.0 || high < 1.0; }
};

std::optional<PairOdds> odds_of(const VoteStatistics& statistics, int a, int b) {
    for (const PairComparison& pair : statistics.pairs) {
        if (pair.a == a && pair.b == b) return PairOdds{pair.odds, pair.low, pair.high, pair.p};
        if (pair.a == b && pair.b == a) {
            return PairOdds{1.0 / pair.odds, 1.0 / pair.high, 1.0 / pair.low, pair.p};
        }
    }
    return std::nullopt;
}

std::vector<ChartTick> odds_ticks(double low, double high) {
    std::vector<ChartTick> ticks;
    const bool many = high / low > 300.0;
    for (int decade = -4; decade <= 4; ++decade) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            if (many && digit != 1.0) continue;
            const double value = digit * std::pow(10.0, decade);
            if (value < low * 0.999 || value > high * 1.001) continue;
            ticks.push_back({value, fmt::format("{:g}", value)});
        }
    }
    return ticks;
}

/// The ends of an axis of odds: all of the intervals, but for what lies beyond a thousandfold.
std::pair<double, double> odds_range(const std::vector<PairOdds>& all) {
    double low = 0.5, high = 2.0;
    for (const PairOdds& pair : all) {
        low = std::min(low, std::max(pair.low, 1e-3));
        high = std::max(high, std::min(pair.high, 1e3));
    }
    return {low / 1.15, high * 1.15};
}

/// A horizontal interval; an end that lies outside the axis has an arrow head.
void draw_interval(VectorDrawing& drawing, const ChartAxis& axis, const PairOdds& pair, double y) {
    const double left = axis.at(std::max(pair.low, axis.low));
    const double right = axis.at(std::min(pair.high, axis.high));
    drawing.add(DrawnLine{{left, y}, {right, y}, kStrongColour, 1.8});
    const auto end = [&](double x, bool cut, double inward) {
        if (cut) {
            DrawnShape head{{{x, y}, {x + 6.0 * inward, y - 3.6}, {x + 6.0 * inward, y + 3.6}}};
            head.fill = kStrongColour;
            drawing.add(head);
        } else {
            drawing.add(DrawnLine{{x, y - 3.6}, {x, y + 3.6}, kStrongColour, 1.8});
        }
    };
    end(left, pair.low < axis.low, 1.0);
    end(right, pair.high > axis.high, -1.0);
}

std::string interval_text(const PairOdds& pair) {
    return fmt::format(
        "{} [{}, {}]", odds_text(pair.odds), odds_text(pair.low), odds_text(pair.high));
}

}  // namespace

ReportChart worths_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    const int leader = statistics.verdict.leader >= 0 ? statistics.verdict.leader : rows.order[0];
    const std::string& name = rows.labels[static_cast<std::size_t>(leader)];
    ReportChart chart{"Worths, as multiples of the leader's", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const ChartFrame frame = begin_rows(drawing, rows, 6.0, 118.0);
    std::vector<PairOdds> all;
    for (const int design : rows.order) {
        all.push_back(odds_of(statistics, design, leader).value_or(PairOdds{}));
    }
    const auto [low, high] = odds_range(all);
    const ChartAxis axis{low, high, frame.left, frame.right, true};
    draw_axis(drawing,
              frame,
              axis,
              odds_ticks(low, high),
              "worth over the leader's worth, with its 95% interval (logarithmic)");
    drawing.add(DrawnLine{
        {axis.at(1.0), frame.top}, {axis.at(1.0), frame.bottom()}, kSoftInkColour, 1.1, 3.0});
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const double y = frame.middle(row);
        const PairOdds& pair = all[row];
        const bool is_leader = rows.order[row] == leader;
        std::string figures = "leader: 1";
        if (!is_leader) {
            draw_interval(drawing, axis, pair, y);
            figures = interval_text(pair);
        }
        const double place = std::clamp(pair.odds, axis.low, axis.high);
        add_dot(
            drawing, {axis.at(place), y}, told_from_leader(statistics.verdict, rows.order[row]));
        add_figures(chart, rows, row, y, figures);
    }
    chart.note = fmt::format(
        "For one who prefers {}, so many prefer the other: Plackett and Luce's model, 95% "
        "profile-likelihood intervals, each a comparison by itself. Hollow marks are told from {}, "
        "as the verdict has it.{}",
        name,
        name,
        statistics.ghost ? kGhostIntervals : "");
    return chart;
}

ReportChart pairs_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportChart chart{"Each design against each other", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const std::size_t count = rows.order.size();
    const ChartFrame frame = begin_rows(drawing, rows, 24.0, 0.0);
    // Two designs need no cells as wide as a hand.
    const double cell = std::min(76.0, (drawing.width - frame.left) / static_cast<double>(count));
    const bool has_text = cell >= 29.0;
    drawing.height = frame.bottom() + 4.0;
    for (std::size_t column = 0; column < count; ++column) {
        drawing.add(
            DrawnText{{frame.left + cell * (static_cast<double>(column) + 0.5), frame.top - 7.0},
                      rows.keys[static_cast<std::size_t>(rows.order[column])],
                      9.0,
                      TextAnchor::middle,
                      kInkColour,
                      true});
    }
    // Frames lie over the neighbours' fields.
    std::vector<DrawnShape> frames;
    for (std::size_t row = 0; row < count; ++row) {
        for (std::size_t column = 0; column < count; ++column) {
            const double left = frame.left + cell * static_cast<double>(column);
            const double top = frame.top + frame.row_height * static_cast<double>(row);
            DrawnShape field = drawn_box(left + 0.8, top + 0.8, cell - 1.6, frame.row_height - 1.6);
            const auto pair = odds_of(statistics, rows.order[row], rows.order[column]);
            if (!pair) {
                field.fill = kGridColour;
                if (row == column) drawing.add(field);
                continue;
            }
            const double strength = std::clamp(std::log(pair->odds) / std::log(20.0), 0.0, 1.0);
            const auto mixed = [&](unsigned shift) {
                const double from = static_cast<double>(kPaperColour >> shift & 255u);
                const double to = static_cast<double>(kMiddleColour >> shift & 255u);
                return static_cast<DrawingColour>(std::lround(from + strength * (to - from)))
                       << shift;
            };
            field.fill = mixed(16) | mixed(8) | mixed(0);
            field.stroke = kGridColour;
            field.width = 0.6;
            drawing.add(field);
            if (pair->excludes_one()) {
                DrawnShape bold = field;
                bold.fill.reset();
                bold.stroke = kInkColour;
                bold.width = 1.6;
                frames.push_back(bold);
            }
            if (!has_text) continue;
            const double middle = left + 0.5 * cell;
            const bool two_lines = frame.row_height > 24.0 && cell >= 46.0;
            std::string odds = odds_text(pair->odds);
            if (odds.starts_with("over")) odds = ">9999";
            if (odds.starts_with("under")) odds = "<0.001";
            drawing.add(DrawnText{{middle, frame.middle(row) + (two_lines ? -1.0 : 3.0)},
                                  odds,
                                  cell < 40.0 ? 7.5 : 9.0,
                                  TextAnchor::middle,
                                  kInkColour,
                                  pair->excludes_one()});
            if (two_lines) {
                const std::string p =
                    pair->p < 0.001 ? "p <0.001" : fmt::format("p {:.3f}", pair->p);
                drawing.add(DrawnText{
                    {middle, frame.middle(row) + 9.0}, p, 7.5, TextAnchor::middle, kInkColour});
            }
        }
    }
    for (DrawnShape& bold : frames) drawing.add(std::move(bold));
    int separated = 0;
    for (const PairComparison& pair : statistics.pairs) {
        separated += PairOdds{pair.odds, pair.low, pair.high, pair.p}.excludes_one() ? 1 : 0;
    }
    chart.alternative = fmt::format(
        "A table of odds, the same as in the table of pairs: of {} pairs {} have a 95% interval "
        "without 1.",
        statistics.pairs.size(),
        separated);
    chart.note =
        "Worth of the row's design over worth of the column's: the darker, the more the row's is "
        "preferred. A frame: the 95% profile-likelihood interval is without 1. Each pair by "
        "itself: "
        "of many pairs some are framed by chance.";
    return chart;
}

ReportChart power_chart(const VoteStatistics& statistics,
                        const std::vector<VoteStatistics::Power>& curve,
                        const ChartRows& rows) {
    const auto name = [&](int design) { return rows.labels[static_cast<std::size_t>(design)]; };
    ReportChart chart{"What a fresh round would tell", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    ChartFrame frame{34.0, drawing.width - 10.0, 12.0, 150.0};
    frame.rows = 1.0;
    drawing.height = frame.bottom() + 34.0;
    const double most = static_cast<double>(curve.back().evaluators);
    const ChartAxis across{0.0, most * 1.02, frame.left, frame.right};
    const ChartAxis up{0.0, 1.0, frame.bottom(), frame.top};
    draw_axis(drawing,
              frame,
              across,
              linear_ticks(0.0, most * 1.02, 10, true),
              "evaluators of a fresh round, counted by itself");
    for (const int percent : {0, 20, 40, 60, 80, 100}) {
        const double y = up.at(percent / 100.0);
        drawing.add(DrawnLine{{frame.left, y},
                              {frame.right, y},
                              percent == 80 ? kSoftInkColour : kGridColour,
                              percent == 80 ? 1.1 : 0.7,
                              percent == 80 ? 3.0 : 0.0});
        drawing.add(DrawnText{{frame.left - 5.0, y + 2.8},
                              fmt::format("{}%", percent),
                              8.0,
                              TextAnchor::end,
                              kSoftInkColour});
    }
    double current = 0.0;
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const DrawingPoint here{across.at(curve[k].evaluators), up.at(curve[k].power)};
        if (k > 0) {
            drawing.add(DrawnLine{{across.at(curve[k - 1].evaluators), up.at(curve[k - 1].power)},
                                  here,
                                  kStrongColour,
                                  2.0});
        }
        if (curve[k].evaluators == statistics.evaluators) current = curve[k].power;
        chart.alternative += fmt::format("{}{} evaluators: {}",
                                         k == 0 ? "" : "; ",
                                         curve[k].evaluators,
                                         percent_text(curve[k].power));
    }
    chart.alternative += ".";
    for (const auto& point : curve) {
        drawing.add(
            DrawnDot{{across.at(point.evaluators), up.at(point.power)}, 2.6, kStrongColour});
    }
    // This round's number. The curve rises: what it leaves free lies above its beginning and below
    // its end.
    const double x = across.at(statistics.evaluators), y = up.at(current);
    const bool above = current < 0.5;
    drawing.add(DrawnLine{{x, frame.bottom()}, {x, above ? frame.top : y}, kWarmColour, 1.2, 2.0});
    drawing.add(DrawnDot{{x, y}, 5.2, kPaperColour, kWarmColour, 2.2});
    const std::string words =
        fmt::format("as many as now: {}, {}", statistics.evaluators, percent_text(current));
    const double width = estimated_width(words, kFigureSize, true);
    const bool before = x + 8.0 + width > frame.right;
    const double baseline = above ? frame.top + 12.0 : frame.bottom() - 8.0;
    DrawnShape ground =
        drawn_box(before ? x - 8.0 - width : x + 3.0, baseline - 9.0, width + 5.0, 12.0);
    ground.fill = kPaperColour;
    drawing.add(ground);
    drawing.add(DrawnText{{before ? x - 6.0 : x + 6.0, baseline},
                          words,
                          kFigureSize,
                          before ? TextAnchor::end : TextAnchor::start,
                          kWarmColour,
                          true});
    chart.note = fmt::format(
        "In how many of fresh rounds, drawn at the fitted worths, the likelihood ratio would tell "
        "{} "
        "from {} at 5%. ",
        name(statistics.verdict.leader),
        name(statistics.verdict.rival));
    // Beyond what a round may have the figure would be a number and no more.
    chart.note += statistics.evaluators_needed.value_or(kMostEvaluators + 1) <= kMostEvaluators
                      ? fmt::format(
                            "80% need about {} evaluators; what leads is, in the mean, not "
                            "as far ahead as it looks, so take that as the least.",
                            *statistics.evaluators_needed)
                      : fmt::format("80% would need more than {} evaluators.", kMostEvaluators);
    return chart;
}

}  // namespace livery
