#include "studio/presenting/round_files.h"

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
#include "jobs/calibrate/calibration_grade.h"
#include "jobs/picture.h"
#include "live/vote_frames.h"

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
    studio.background->run(
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
                notify(studio,
                       {Notice::Level::info,
                        "The report is written.",
                        (folder / "report.pdf").string(),
                        "report.html beside it says the same for a browser."});
            };
        },
        [&studio](std::exception_ptr why) {
            notify_failure(studio, "The report could not be written.", why);
        });
}

}  // namespace livery
