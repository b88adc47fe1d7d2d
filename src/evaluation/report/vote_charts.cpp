#include "evaluation/report/vote_charts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "evaluation/report/chart_frame.h"
#include "evaluation/report/figure_words.h"

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
        DrawnDot dot{{axis.at(sum), frame.middle(row)}, 4.6, kStrongColour};
        if (told) {
            dot.fill = kPaperColour;
            dot.stroke = kStrongColour;
            dot.width = 1.8;
        }
        drawing.add(dot);
        drawing.add(DrawnText{{drawing.width, frame.middle(row) + 3.1},
                              fmt::format("{:.1f}", sum),
                              kFigureSize,
                              TextAnchor::end});
        chart.alternative += fmt::format("{}{}: {:.1f}", row == 0 ? "" : "; ", rows.labels[k], sum);
    }
    chart.alternative += ".";
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
        const std::string figures = percent_text(chance);
        drawing.add(DrawnText{
            {drawing.width, frame.middle(row) + 3.1}, figures, kFigureSize, TextAnchor::end});
        chart.alternative += fmt::format("{}{}: {}", row == 0 ? "" : "; ", rows.labels[k], figures);
    }
    chart.alternative += ".";
    chart.note = fmt::format(
        "Of rounds of {} other evaluators ({}), with what these ballots leave open of how well the "
        "designs are liked. Where several are first, they share it. Of designs that are liked "
        "alike "
        "it says too much of the one that happens to lead.",
        statistics.evaluators,
        method_text(statistics.predicted.method, statistics.predicted.cases));
    return chart;
}

}  // namespace livery
