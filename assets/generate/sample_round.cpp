// Writes a round of votes that nobody cast, for newcomers to look at: ballots.sqlite and
// ballots-round-1/round.json below a folder. 24 ballots on four of the shipped looks, drawn with a
// fixed seed: the same bytes every time. livery_generate_sample_round FOLDER
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/hash.h"
#include "core/json.h"
#include "core/paths.h"
#include "evaluation/ballots.h"
#include "evaluation/presentation_order.h"
#include "evaluation/statistics/ballot_law.h"

namespace livery {
namespace {

constexpr int kSeed = 15, kEvaluators = 24, kWave = 3;
/// Ours: what the evaluators, whom there are none of, are taken to like.
const std::vector<double> kWorths = {0.22, 0.42, 0.08, 0.28};
/// Those of the shipped looks.
const std::vector<std::string> kDesigns = {
    "Solid red", "Silver metallic", "Solid ivory", "Blue metallic"};

/// So many seconds after nine o'clock of the day.
std::string time_at(int seconds) {
    return fmt::format(
        "2026-11-20T{:02}:{:02}:{:02}Z", 9 + seconds / 3600, seconds / 60 % 60, seconds % 60);
}

constexpr int kJoining_s = 15, kOpened_s = 900, kShowing_s = 180, kVoting_s = 2460;

/// By which SQLite tells kinds of files apart: bytes 68 to 71 of the file.
std::int32_t application_id_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    stream.seekg(68);
    std::uint32_t id = 0;
    for (int k = 0; k < 4; ++k) id = id << 8u | static_cast<std::uint32_t>(stream.get() & 255);
    return static_cast<std::int32_t>(id);
}

/// Through the log, as the store writes it, but at times of our own.
void write_ballots(const std::filesystem::path& file, const std::vector<int>& codes) {
    std::filesystem::remove(file);
    remove_logs_of(file);
    { const BallotStore made(file); }
    Database database(file,
                      Database::Mode::existing,
                      application_id_of(file),
                      std::numeric_limits<int>::max(),
                      ballots_schema());
    Transaction transaction(database);
    LogSeal end;
    const auto add = [&](int round, int at_s, LogEntry::What what) {
        LogEntry entry{1, round, time_at(at_s), std::move(what)};
        append_to_log(database, end, entry);
    };
    add(0, 0, LogEntry::Session{});
    for (int seat = 1; seat <= kEvaluators; ++seat) {
        Hasher hasher;
        hasher.add("a seat of the sample, " + std::to_string(seat));
        add(0, kJoining_s * seat, LogEntry::Seat{seat, true, hasher.hex() + hasher.hex()});
    }
    add(1, kOpened_s, LogEntry::Open{"", true, kSeed});
    for (std::size_t k = 0; k < kDesigns.size(); ++k) {
        add(1, kOpened_s, LogEntry::Design{static_cast<int>(k), kDesigns[k], codes[k]});
    }
    add(1, kVoting_s, LogEntry::Voting{});
    const BallotLaw law = ballot_law(kWorths, true);
    Random random(kSeed);
    const auto ballots = draw_round(law, kEvaluators, random);
    for (int seat = 1; seat <= kEvaluators; ++seat) {
        add(1,
            kVoting_s + 7 * seat,
            LogEntry::Vote{seat, ballots[static_cast<std::size_t>(seat - 1)]});
    }
    add(1, kVoting_s + 240, LogEntry::Close{});
    transaction.commit();
}

Json details_of(const std::vector<int>& codes) {
    Json looks = Json::array(), showings = Json::array();
    for (std::size_t k = 0; k < codes.size(); ++k) {
        looks.push_back({{"code", codes[k]}, {"picture", fmt::format("look-{}.jpg", k + 1)}});
    }
    const PresentationOrder order = presentation_order(
        static_cast<int>(codes.size()), kEvaluators, kWave, static_cast<std::uint64_t>(kSeed));
    int seat = 1, wave_number = 0;
    for (const Wave& wave : order.waves) {
        Json seats = Json::array(), shown = Json::array();
        for (int k = 0; k < wave.evaluators; ++k) seats.push_back(seat++);
        for (const int design : wave.designs)
            shown.push_back(codes[static_cast<std::size_t>(design)]);
        showings.push_back({{"at", time_at(kOpened_s + 60 + kShowing_s * wave_number++)},
                            {"seats", seats},
                            {"codes", shown}});
    }
    return {{"format_version", 1},
            {"kind", "round-details"},
            {"round", 1},
            {"title", "A sample round: four paints of the car"},
            {"question", "Which paint suits this car best?"},
            {"note",
             "This is a made-up sample that comes with the program: nobody voted. Its ballots were "
             "drawn with a fixed seed, and its times are invented."},
            {"looks", looks},
            {"showings", showings}};
}

}  // namespace
}  // namespace livery

int main(int argument_count, char** arguments) {
    using namespace livery;
    if (argument_count != 2) {
        std::cerr << "usage: livery_generate_sample_round FOLDER\n";
        return 2;
    }
    try {
        const std::filesystem::path folder = arguments[1];
        make_output_folder(folder / "ballots-round-1");
        const auto codes =
            draw_codes(static_cast<int>(kDesigns.size()), static_cast<std::uint64_t>(kSeed), 1);
        write_ballots(folder / "ballots.sqlite", codes);
        write_json_file(folder / "ballots-round-1/round.json", details_of(codes));
    } catch (const std::exception& error) {
        std::cerr << "livery_generate_sample_round: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
