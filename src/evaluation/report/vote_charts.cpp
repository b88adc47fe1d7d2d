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
    ReportChart chart{"Rank sums: over all pairs at once", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const bool has_range = statistics.range_threshold.has_value();
    const ChartFrame frame = begin_rows(drawing, rows, has_range ? 20.0 : 6.0, 44.0);
    const double designs = static_cast<double>(rows.order.size());
    const double evaluators = std::max(1, statistics.evaluators);
    const ChartAxis axis{evaluators, designs * evaluators, frame.left + 8.0, frame.right - 4.0};
    const double first =
        *std::min_element(statistics.rank_sums.begin(), statistics.rank_sums.end());
    if (has_range) {
        const double end = std::min(axis.high, first + *statistics.range_threshold);
        DrawnShape band = drawn_box(axis.at(first),
                                    frame.top,
                                    axis.at(end) - axis.at(first),
                                    frame.row_height * frame.rows);
        band.fill = kFaintColour;
        drawing.add(band);
        drawing.add(DrawnText{
            {axis.at(first), frame.top - 7.0},
            fmt::format("not told from the first: under {:.1f}", *statistics.range_threshold),
            8.0,
            TextAnchor::start,
            kSoftInkColour});
    }
    draw_axis(drawing,
              frame,
              axis,
              linear_ticks(axis.low, axis.high, 9, true),
              "rank sum; the further left, the more liked");
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const std::size_t k = index_of(rows.order[row]);
        const double sum = statistics.rank_sums[k];
        const bool within = !has_range || sum - first < *statistics.range_threshold;
        drawing.add(DrawnLine{
            {frame.left, frame.middle(row)}, {axis.at(sum), frame.middle(row)}, kGridColour, 1.0});
        DrawnDot dot{{axis.at(sum), frame.middle(row)}, 4.6, kStrongColour};
        if (!within) {
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
    if (!has_range) {
        chart.note += "With so few ballots no difference is rare enough to tell two designs apart.";
    } else if (statistics.friedman_p > 0.05) {
        chart.note +=
            "The ballots as a whole show no preference (Friedman), so nothing is told apart, "
            "however far apart two sums lie.";
    } else {
        chart.note += fmt::format(
            "Two designs whose sums differ by {:.1f} or more are told apart: were all liked alike, "
            "any pair at all would differ so much in 5% of rounds at most. Hollow marks are told "
            "from the first.",
            *statistics.range_threshold);
    }
    return chart;
}

ReportChart first_chart(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportChart chart{"Who would be first in another round like this one", "", "", {}};
    VectorDrawing& drawing = chart.drawing;
    const bool resampled = statistics.resampled.has_value();
    const ChartFrame frame = begin_rows(drawing, rows, resampled ? 22.0 : 6.0, 92.0);
    const ChartAxis axis{0.0, 1.0, frame.left, frame.right};
    std::vector<ChartTick> ticks;
    for (const int percent : {0, 25, 50, 75, 100}) {
        ticks.push_back({percent / 100.0, fmt::format("{}%", percent)});
    }
    draw_axis(drawing, frame, axis, ticks, "chance to be first by rank sums");
    if (resampled) {
        const double x =
            legend_entry(drawing, frame.left, 9.0, "under the fitted worths", kMiddleColour, false);
        drawing.add(DrawnDot{{x + 4.0, 6.0}, 3.6, kPaperColour, kStrongColour, 1.6});
        drawing.add(DrawnText{{x + 13.0, 9.0}, "ballots drawn again", 8.5});
    }
    for (std::size_t row = 0; row < rows.order.size(); ++row) {
        const std::size_t k = index_of(rows.order[row]);
        const double chance = statistics.wins.first[k];
        const double height = 0.5 * frame.row_height;
        DrawnShape bar = drawn_box(
            frame.left, frame.middle(row) - 0.5 * height, axis.at(chance) - frame.left, height);
        bar.fill = kMiddleColour;
        drawing.add(bar);
        std::string figures = percent_text(chance);
        if (resampled) {
            const double again = statistics.resampled->first[k];
            drawing.add(DrawnDot{
                {axis.at(again), frame.middle(row)}, 3.6, kPaperColour, kStrongColour, 1.6});
            figures += " / " + percent_text(again);
        }
        drawing.add(DrawnText{
            {drawing.width, frame.middle(row) + 3.1}, figures, kFigureSize, TextAnchor::end});
        chart.alternative += fmt::format("{}{}: {}", row == 0 ? "" : "; ", rows.labels[k], figures);
    }
    chart.alternative += ".";
    chart.note = fmt::format(
        "Of rounds of {} evaluators: under the fitted worths ({}){}. Where several are first, they "
        "share it.",
        statistics.evaluators,
        method_text(statistics.wins.method, statistics.wins.cases),
        resampled
            ? fmt::format(", and from the single ballots drawn again ({})",
                          method_text(statistics.resampled->method, statistics.resampled->cases))
            : "");
    return chart;
}

}  // namespace livery
