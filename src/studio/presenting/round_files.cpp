#include "studio/presenting/round_files.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/replace_folder.h"
#include "core/time.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_report.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/comparison.h"
#include "live/vote_frames.h"
#include "studio/presenting/presenting.h"
#include "studio/seats/seats_panel.h"

namespace livery {

namespace {

Image8 read_bytes_of(const std::filesystem::path& file) {
    const ImageFile read = read_image(file);
    if (read.full_scale != 255.0 || read.image.channels != 3) {
        throw FileError(file, "", "a picture of another kind", "an 8 bit RGB picture");
    }
    Image8 picture(read.image.width, read.image.height, 3);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        picture.values[i] = static_cast<std::uint8_t>(std::lround(read.image.values[i]));
    }
    return picture;
}

}  // namespace

std::string hash_of(const Image8& picture) {
    Hasher hasher;
    hasher.add(std::to_string(picture.width) + "x" + std::to_string(picture.height) + "x" +
               std::to_string(picture.channels));
    hasher.add(std::span<const std::uint8_t>(picture.values));
    return hasher.hex();
}

void write_vote_frames(const std::filesystem::path& folder, const VoteFrames& frames) {
    check_argument(!frames.empty(), "write_vote_frames: found no frames");
    make_private_folder(folder.parent_path());
    FolderReplacement replacement(folder);
    for (const auto& [name, frame] : frames) {
        write_png(replacement.staging() / (name + ".png"), *frame);
    }
    replacement.commit(frames.rbegin()->first + ".png");
}

VoteFrames read_vote_frames(const std::filesystem::path& folder,
                            const std::map<std::string, std::string>& hashes) {
    VoteFrames frames;
    for (const auto& [name, hash] : hashes) {
        const auto file = folder / (name + ".png");
        auto picture = std::make_shared<Image8>(read_bytes_of(file));
        if (const std::string found = hash_of(*picture); found != hash) {
            throw FileError(file,
                            "",
                            "another picture than the one that was frozen (" + found + ")",
                            hash + "; abort the round and present the looks anew");
        }
        frames[name] = std::move(picture);
    }
    return frames;
}

bool is_fair(const LookReachability& reach) {
    return reach.reachable_fraction.value_or(1.0) >= kFairFraction ||
           reach.de00_p95.value_or(0.0) <= kFairDe00;
}

std::string reach_in_words(const LookDetails& look) {
    if (!look.reachability || !look.reachability->reachable_fraction) {
        return fmt::format("{}: not known without a calibration", look.code);
    }
    return fmt::format("{}: {:.0f}% of it as wanted, 95% within {:.1f} (CIEDE2000)",
                       look.code,
                       100.0 * *look.reachability->reachable_fraction,
                       look.reachability->de00_p95.value_or(0.0));
}

std::vector<int> unfair_looks(const RoundDetails& details) {
    std::vector<int> codes;
    for (const LookDetails& look : details.looks) {
        if (look.reachability && !is_fair(*look.reachability)) codes.push_back(look.code);
    }
    return codes;
}

RoundDetails write_frozen_looks(const std::filesystem::path& ballots,
                                const Round& round,
                                const std::vector<FrozenLook>& looks,
                                const ProjectorSetup& setup,
                                const std::optional<RoundEye>& eye) {
    const auto file = round_details_file(ballots, round.id);
    RoundDetails details;
    details.eye = eye;
    details.folder = file.parent_path();
    make_private_folder(details.folder);
    for (std::size_t k = 0; k < looks.size(); ++k) {
        LookDetails& look = details.looks.emplace_back();
        look.code = round.codes.at(k);
        look.picture = fmt::format("look-{}.png", look.code);
        write_png(details.folder / look.picture, srgb_from_working(*looks[k].wanted_working));
        if (const auto reach = reach_of(*looks[k].wanted_working, *looks[k].drive, setup)) {
            look.reachability = {reach->reachable_fraction, reach->de00_median, reach->de00_p95};
        }
    }
    write_round_details(file, round.id, details);
    return details;
}

void write_round_report(Studio& studio, const Round& round) {
    if (!studio.background || !studio.ballots) return;
    std::vector<std::pair<std::string, std::string>> calibration;
    if (studio.setup && studio.setup->calibration &&
        studio.setup->calibration->id == round.calibration_id) {
        calibration = calibration_figures(*studio.setup->calibration);
    }
    in_background(studio,
                  "The report could not be written.",
                  [&studio,
                   id = round.id,
                   seed = static_cast<std::uint64_t>(round.seed),
                   ballots = studio.ballots->file(),
                   calibration](const Progress&) -> Background::Then {
                      RoundReportSource source = round_report_source(ballots, id, seed);
                      source.calibration = calibration;
                      source.program = "livery " LIVERY_VERSION;
                      source.made_at = utc_now();
                      const ReportDocument document = round_report(source);
                      const auto folder = round_details_file(ballots, id).parent_path();
                      make_private_folder(folder);
                      write_text_file(folder / "report.html", html_of(document));
                      write_text_file(folder / "report.pdf", pdf_of(document).bytes);
                      return [&studio, folder] {
                          tell_info(studio,
                                    "The report is written.",
                                    (folder / "report.pdf").string(),
                                    "report.html beside it says the same for a browser.");
                      };
                  });
}

namespace {

/// The session's look of each design of the round; 0: none has its name any more.
std::vector<int> looks_of(const Studio& studio, const Round& round) {
    std::vector<int> looks;
    for (const std::string& name : round.designs) {
        const auto& all = studio.session.document().looks;
        const auto found = std::find_if(all.begin(), all.end(), [&](const SessionLook& look) {
            return look.look.name == name;
        });
        looks.push_back(found == all.end() ? 0 : found->id);
    }
    return looks;
}

/// Whose figures are still to come: nothing without details, seats and looks.
const PresentedRound* to_record(const Studio& studio) {
    const auto& presented = presenting(studio).presented;
    if (!presented || presented->details.looks.empty() || !presented->details.eye) return nullptr;
    const RoundEye& eye = *presented->details.eye;
    const bool open = std::any_of(eye.seats.begin(), eye.seats.end(), [](const RoundSeat& seat) {
        return seat.looks.empty();
    });
    // As they were when the looks were frozen: another session's would be others.
    const bool same = eye == [&] {
        RoundEye now = eye_of_round(studio.session.document());
        for (std::size_t k = 0; k < std::min(now.seats.size(), eye.seats.size()); ++k) {
            now.seats[k].looks = eye.seats[k].looks;
        }
        return now;
    }();
    return open && same ? &*presented : nullptr;
}

void warn(Studio& studio, const std::vector<SeatSees>& all) {
    const std::string unfair = unfair_in_words(all);
    if (unfair.empty()) return;
    tell_warning(studio,
                 unfair,
                 "Whoever sits there judges something else.",
                 "Abort the round, then move the eye or those seats, or let them vote in waves.");
}

void write(Studio& studio, const PresentedRound& presented) {
    if (!studio.background || !studio.ballots) return;
    in_background(studio,
                  "What the seats miss was not kept for the round's report.",
                  [file = round_details_file(studio.ballots->file(), presented.round.id),
                   id = presented.round.id,
                   details = presented.details](const Progress&) -> Background::Then {
                      write_round_details(file, id, details);
                      return [] {};
                  });
}

}  // namespace

RoundEye eye_of_round(const Document& document) {
    RoundEye eye;
    eye.of = in_words(document.seats, document.eye_choice);
    eye.eye_mm = eye_in_use_mm(document);
    for (const EyeSeat& seat : document.seats) {
        eye.seats.push_back({seat.number, seat.eye_mm, seat.counts, {}});
    }
    return eye;
}

std::vector<int> looks_to_record(const Studio& studio) {
    const PresentedRound* presented = to_record(studio);
    if (!presented) return {};
    std::vector<int> looks = looks_of(studio, presented->round);
    std::erase(looks, 0);
    return looks;
}

void record_seat_errors(Studio& studio) {
    const auto& results = studio.panels.of<SeatsPanelState>().results;
    if (!results || results->number != studio.panels.of<SeatsPanelState>().number ||
        !to_record(studio))
        return;
    PresentedRound& presented = *presenting(studio).presented;
    const std::vector<int> looks = looks_of(studio, presented.round);
    if (std::find(looks.begin(), looks.end(), 0) != looks.end()) return;
    const auto& seats = studio.session.document().seats;
    const auto all = worst_looks(*results, seats, looks);
    if (all.size() != seats.size()) return;
    for (RoundSeat& seat : presented.details.eye->seats) {
        for (std::size_t k = 0; k < looks.size(); ++k) {
            const SeatError& error = results->looks.at(looks[k]).at(seat.seat).error;
            seat.looks.push_back(
                {presented.round.codes.at(k), error.de00_median, error.de00_p95, error.share_over});
        }
    }
    warn(studio, all);
    write(studio, presented);
}

}  // namespace livery
