#include "evaluation/statistics/plackett_luce.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

namespace livery {

namespace {

// Of fixed capacity: a fit of four designs is over before memory would have been asked for.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostDesigns, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostDesigns, kMostDesigns>;
using Index = Eigen::Index;

struct Curvature {
    double value = 0.0;
    Vector gradient;
    Matrix information;  ///< minus the second derivatives
};

/// `count` times ln of the sum of e^(sign * theta) over all but a and b (-1: none) is taken off.
void take_choice(Curvature& at, const Vector& theta, double count, double sign, Index a, Index b) {
    if (!(count > 0.0)) return;
    double largest = -1e300;
    for (Index i = 0; i < theta.size(); ++i) {
        if (i != a && i != b) largest = std::max(largest, sign * theta[i]);
    }
    Vector share(theta.size());
    double sum = 0.0;
    for (Index i = 0; i < theta.size(); ++i) {
        share[i] = i == a || i == b ? 0.0 : std::exp(sign * theta[i] - largest);
        sum += share[i];
    }
    share /= sum;
    at.value -= count * (largest + std::log(sum));
    at.gradient -= count * sign * share;
    at.information.diagonal() += count * share;
    at.information.noalias() -= count * share * share.transpose();
}

Curvature curvature(const LuceData& data, const Vector& theta) {
    const Index designs = theta.size();
    Curvature at{0.0, Vector::Zero(designs), Matrix::Zero(designs, designs)};
    double ballots = 0.0;
    for (Index i = 0; i < designs; ++i) {
        const auto k = static_cast<std::size_t>(i);
        double named = data.best[k] + data.second[k];
        if (!data.least.empty()) named -= data.least[k];
        at.value += named * theta[i];
        at.gradient[i] += named;
        ballots += data.best[k];
    }
    take_choice(at, theta, ballots, 1.0, -1, -1);
    for (Index i = 0; i < designs; ++i) {
        take_choice(at, theta, data.best[static_cast<std::size_t>(i)], 1.0, i, -1);
        for (Index j = 0; j < designs && !data.least.empty(); ++j) {
            take_choice(
                at, theta, data.pairs[static_cast<std::size_t>(i * designs + j)], -1.0, i, j);
        }
    }
    if (!(data.ghost > 0.0)) return at;
    for (Index i = 0; i < designs; ++i) {
        // A win and a loss: theta - 2 ln(1 + e^theta), written so that it cannot overflow.
        const double far = std::abs(theta[i]);
        const double share = 1.0 / (1.0 + std::exp(-theta[i]));
        at.value -= data.ghost * (far + 2.0 * std::log1p(std::exp(-far)));
        at.gradient[i] += data.ghost * (1.0 - 2.0 * share);
        at.information(i, i) += data.ghost * 2.0 * share * (1.0 - share);
    }
    return at;
}

/// Log-worths from what is free: b and, `log_odds` above it, a are one of them.
struct Coordinates {
    Index designs = 0;
    std::optional<HeldOdds> held;

    Index free() const { return held ? designs - 1 : designs; }
    Index of(Index design) const {
        if (!held) return design;
        if (design == held->a) design = held->b;
        return design > held->a ? design - 1 : design;
    }
    Vector theta(const Vector& free) const {
        Vector theta(designs);
        for (Index i = 0; i < designs; ++i) theta[i] = free[of(i)];
        if (held) theta[held->a] += held->log_odds;
        return theta;
    }
    Curvature reduced(const Curvature& full) const {
        if (!held) return full;
        Curvature at{full.value, Vector::Zero(free()), Matrix::Zero(free(), free())};
        for (Index i = 0; i < designs; ++i) {
            at.gradient[of(i)] += full.gradient[i];
            for (Index j = 0; j < designs; ++j) {
                at.information(of(i), of(j)) += full.information(i, j);
            }
        }
        return at;
    }
};

/// All log-worths may move together where nothing holds them: they are kept from it. Where the
/// likelihood is all but flat a trace of what it is elsewhere keeps rounding from turning it over.
Matrix held_together(const Curvature& at, bool ghost) {
    Matrix held = at.information;
    held.diagonal().array() += 1e-13 * at.information.diagonal().maxCoeff();
    if (!ghost) held.array() += 1.0;
    return held;
}

}  // namespace

bool needs_ghost(const VoteCounts& counts) {
    int named_best = 0;
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        if (counts.best[i] + counts.second[i] == 0) return true;
        if (counts.best[i] > 0) ++named_best;
    }
    return named_best < 2;
}

LuceData luce_data(const VoteCounts& counts, const std::vector<Ballot>* ballots) {
    LuceData data;
    data.best.assign(counts.best.begin(), counts.best.end());
    data.second.assign(counts.second.begin(), counts.second.end());
    data.least.assign(counts.least.begin(), counts.least.end());
    data.ghost = needs_ghost(counts) ? kGhost : 0.0;
    if (!counts.has_least()) return data;
    if (!ballots) {
        data.pairs = expected_pairs(counts);
        return data;
    }
    const std::size_t designs = counts.best.size();
    data.pairs.assign(designs * designs, 0.0);
    for (const Ballot& ballot : *ballots) {
        data.pairs[static_cast<std::size_t>(ballot.best) * designs +
                   static_cast<std::size_t>(ballot.second)] += 1.0;
    }
    return data;
}

LuceData luce_data(const ExpectedVotes& votes) {
    return {votes.best, votes.second, votes.least, votes.pairs};
}

LuceFit fit_luce(const LuceData& data,
                 const std::optional<HeldOdds>& held,
                 const std::vector<double>& start) {
    const auto designs = static_cast<Index>(data.best.size());
    const Coordinates coordinates{designs, held};
    Vector free = Vector::Zero(coordinates.free());
    if (!start.empty()) {
        for (Index i = 0; i < designs; ++i) {
            if (!held || i != held->a) free[coordinates.of(i)] = start[static_cast<std::size_t>(i)];
        }
    }
    double ballots = 1.0;
    for (const double best : data.best) ballots += best;
    constexpr int most_steps = 200;
    Curvature at = coordinates.reduced(curvature(data, coordinates.theta(free)));
    int step = 0;
    for (; step < most_steps; ++step) {
        if (at.gradient.cwiseAbs().maxCoeff() <= 1e-9) break;
        const Vector move = held_together(at, data.ghost > 0.0).llt().solve(at.gradient);
        // No step over more than a factor of e^4: far out the curvature tells nothing of here.
        double part = std::min(1.0, 4.0 / std::max(1e-300, move.cwiseAbs().maxCoeff()));
        bool climbs = false;
        for (int halving = 0; halving < 40 && !climbs; ++halving, part *= 0.5) {
            const Vector there = free + part * move;
            Curvature next = coordinates.reduced(curvature(data, coordinates.theta(there)));
            // As good to the last digit is good enough: the derivative decides.
            climbs = next.value >= at.value - 1e-13 * ballots * (1.0 + std::abs(at.value)) &&
                     std::isfinite(next.value);
            if (!climbs) continue;
            free = there;
            at = std::move(next);
        }
        if (!climbs) break;
    }
    // What rounding leaves of a derivative grows with the ballots.
    if (const double left = at.gradient.cwiseAbs().maxCoeff(); !(left <= 1e-9 * ballots)) {
        throw std::logic_error("fit_luce: found a derivative of " + std::to_string(left) +
                               " after " + std::to_string(step) + " steps, expected 0");
    }
    LuceFit fit;
    fit.log_likelihood = at.value;
    const Vector theta = coordinates.theta(free);
    const double mean = data.ghost > 0.0 ? 0.0 : theta.mean();
    for (Index i = 0; i < designs; ++i) fit.log_worths.push_back(theta[i] - mean);
    return fit;
}

std::vector<double> worths_of(const LuceFit& fit) {
    const double largest = *std::max_element(fit.log_worths.begin(), fit.log_worths.end());
    std::vector<double> worths;
    double sum = 0.0;
    for (const double log_worth : fit.log_worths) {
        worths.push_back(std::exp(log_worth - largest));
        sum += worths.back();
    }
    for (double& worth : worths) worth /= sum;
    return worths;
}

double standard_error(const LuceData& data, const LuceFit& fit, int a, int b) {
    const auto designs = static_cast<Index>(fit.log_worths.size());
    Vector theta(designs), difference = Vector::Zero(designs);
    for (Index i = 0; i < designs; ++i) theta[i] = fit.log_worths[static_cast<std::size_t>(i)];
    difference[a] = 1.0;
    difference[b] = -1.0;
    const Matrix information = held_together(curvature(data, theta), data.ghost > 0.0);
    return std::sqrt(difference.dot(information.llt().solve(difference)));
}

double deviance(const LuceData& data, const LuceFit& fit, const HeldOdds& held) {
    const LuceFit tied = fit_luce(data, held, fit.log_worths);
    return std::max(0.0, 2.0 * (fit.log_likelihood - tied.log_likelihood));
}

}  // namespace livery
