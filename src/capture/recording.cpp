#include "capture/recording.h"

#include <cmath>
#include <span>

#include <fmt/format.h>

#include "capture/captures_folder.h"
#include "capture/manifest_io.h"
#include "capture/recording_list_io.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace livery {

namespace {

/// A picture that is shown anew in the middle of its photographs: the slowest projector's delay.
constexpr int kSettling = 6;

std::string hash_of(const Image8& drive) {
    Hasher hasher;
    const int size[] = {drive.width, drive.height, drive.channels};
    hasher.add(std::span<const int>(size));
    hasher.add(std::span<const std::uint8_t>(drive.values));
    return hasher.hex();
}

Photograph load(const std::filesystem::path& folder, const RecordedPhotograph& recorded) {
    Capture capture;
    capture.file = folder / recorded.file;
    capture.exposure_s = recorded.exposure_s;
    capture.raw_half = true;  // As cameras on a cable read theirs.
    Photograph photograph = load_photograph(capture);
    photograph.black_level = recorded.black_level;
    photograph.saturates_at = recorded.saturates_at;
    photograph.kept_as = {recorded.file};
    return photograph;
}

}  // namespace

Recording::Recording(std::filesystem::path folder, std::string bench)
    : folder_(std::move(folder)), bench_words_(std::move(bench)) {
    make_output_folder(folder_);
    const auto file = folder_ / "recording.json";
    if (std::error_code error; std::filesystem::exists(file, error)) read(file);
}

Recording::~Recording() {
    try {
        flush();
    } catch (const FileError&) {
        // Whoever wants to know has called flush().
    }
}

void Recording::read(const std::filesystem::path& file) {
    RecordingList list = parse_recording_list(read_text_file(file), file);
    if (list.bench != bench_words_) {
        throw Refused("the photographs in " + folder_.string() + " were taken with " +
                          printable(list.bench) + ", not with " + bench_words_,
                      "go on with what they were taken with, or choose an empty folder");
    }
    showings_ = std::move(list.showings);
    files_ = next_file_number(showings_);
}

BenchPorts Recording::ports(const BenchPorts& bench) {
    check_argument(!bench.turn_to, "photographs that lie in a folder are not recorded again");
    bench_ = bench;
    place_.reset();
    places_.clear();
    shown_.clear();
    last_taken_.clear();
    BenchPorts ports;
    ports.show = [this](const Image8& drive) { show(drive); };
    ports.photograph = [this](double asked_s) { return photograph(asked_s); };
    ports.announce = [this](const std::string& what) {
        announced_ = what;
        if (bench_.announce) bench_.announce(what);
    };
    if (bench.measure_xyz) ports.measure_xyz = [this](glm::dvec2 place) { return measure(place); };
    return ports;
}

void Recording::turn_to(const std::string& picture) {
    const std::size_t from = place_ ? *place_ + 1 : 0;
    std::size_t found = from;
    while (found < showings_.size() && showings_[found].picture != picture) ++found;
    if (found == showings_.size()) {
        found = from;
        const std::lock_guard lock(mutex_);
        showings_.insert(showings_.begin() + static_cast<std::ptrdiff_t>(from),
                         RecordedShowing{picture, {}, {}});
    }
    place_ = found;
    places_.push_back(found);
    next_ = measured_ = 0;
}

void Recording::show(const Image8& drive) {
    drive_ = drive;
    const std::string picture = hash_of(drive);
    turn_to(picture);
    if (!showings_[*place_].photographs.empty() || !bench_.show) return;
    shown_.clear();
    bench_.show(drive);
    shown_ = picture;
}

/// Shows what has been answered for so far from the folder, and waits until it must be there.
void Recording::bring_up(double asked_s) {
    const std::string& picture = showings_[*place_].picture;
    if (shown_ == picture) return;
    shown_.clear();
    if (bench_.show) bench_.show(drive_);
    for (int i = 0; i < kSettling; ++i) bench_.photograph(asked_s);
    shown_ = picture;
}

Photograph Recording::photograph(double asked_s) {
    if (!place_) turn_to("");  // whatever the projector showed before
    RecordedShowing& showing = showings_[*place_];
    if (next_ < showing.photographs.size() && showing.photographs[next_].asked_s == asked_s) {
        Photograph known = load(folder_, showing.photographs[next_]);
        ++next_;
        ++answered_;
        if (on_photograph_) on_photograph_(*place_, known);
        return known;
    }
    return take(asked_s);
}

Photograph Recording::take(double asked_s) {
    if (!bench_.photograph) {
        throw FileError(folder_,
                        "photographs",
                        fmt::format("none of {} at {:.4g} s in its place", announced_, asked_s),
                        "a recording of the whole run");
    }
    bring_up(asked_s);
    Photograph photograph = bench_.photograph(asked_s);
    ++taken_;
    keep(photograph, asked_s);
    ++next_;
    if (on_photograph_) on_photograph_(*place_, photograph);
    return photograph;
}

void Recording::keep(Photograph& photograph, double asked_s) {
    flush();  // The last one's: two at a time would not be safer.
    const std::string suffix =
        photograph.file ? std::filesystem::path(photograph.file->name).extension().string()
                        : ".exr";
    RecordedPhotograph recorded{fmt::format("{:04}{}", files_++, suffix),
                                announced_,
                                asked_s,
                                photograph.exposure_s,
                                photograph.black_level,
                                photograph.saturates_at};
    photograph.kept_as = {recorded.file};
    const auto file = folder_ / recorded.file;
    {
        const std::lock_guard lock(mutex_);
        auto& photographs = showings_[*place_].photographs;
        photographs.resize(next_);  // What comes behind was asked for otherwise.
        photographs.push_back(std::move(recorded));
    }
    last_taken_ = photograph.kept_as.front();
    write([file, image = photograph.image, camera_file = photograph.file] {
        if (!camera_file) return write_exr(file, image);
        write_text_file(
            file,
            {reinterpret_cast<const char*>(camera_file->bytes.data()), camera_file->bytes.size()});
    });
}

/// The list after `first`, so that it names only what is there; on a thread of its own, so that a
/// camera need not wait for the disk.
void Recording::write(std::function<void()> first) {
    writing_ = std::async(std::launch::async,
                          [first = std::move(first),
                           list = folder_ / "recording.json",
                           text = text_of(RecordingList{bench_words_, showings_})] {
                              first();
                              write_text_file(list, text);
                          });
}

void Recording::drop_last() {
    flush();
    if (last_taken_.empty()) return;
    {
        const std::lock_guard lock(mutex_);
        for (RecordedShowing& showing : showings_) {
            std::erase_if(showing.photographs, [&](const RecordedPhotograph& photograph) {
                return photograph.file == last_taken_;
            });
        }
    }
    last_taken_.clear();
    write([] {});
    flush();
}

void Recording::drop_newest(int pictures) {
    flush();
    {
        const std::lock_guard lock(mutex_);
        for (; pictures > 0 && !places_.empty(); --pictures) {
            showings_[places_.back()].photographs.clear();
            showings_[places_.back()].measured.clear();
            places_.pop_back();
        }
    }
    last_taken_.clear();
    write([] {});
    flush();
}

void Recording::flush() {
    if (writing_.valid()) writing_.get();
}

glm::dvec3 Recording::measure(glm::dvec2 pixel) {
    check_argument(place_.has_value(), "a measurement before anything was shown");
    RecordedShowing& showing = showings_[*place_];
    if (measured_ < showing.measured.size() && showing.measured[measured_].first == pixel) {
        return showing.measured[measured_++].second;
    }
    bring_up(0.0);
    const glm::dvec3 xyz = bench_.measure_xyz(pixel);
    const std::lock_guard lock(mutex_);
    showing.measured.resize(measured_);
    showing.measured.emplace_back(pixel, xyz);
    ++measured_;
    return xyz;
}

void Recording::write_manifest(int projector_width,
                               int projector_height,
                               const std::vector<std::pair<std::string, std::string>>& kept) {
    flush();
    CapturesFolder captures{folder_, projector_width, projector_height, {}};
    for (const auto& [role, file] : kept) {
        for (const RecordedShowing& showing : showings_) {
            for (const RecordedPhotograph& photograph : showing.photographs) {
                if (photograph.file != file) continue;
                Capture capture;
                capture.role = role;
                capture.file = file;
                capture.exposure_s = photograph.exposure_s;
                capture.black_level = photograph.black_level;
                if (std::isfinite(photograph.saturates_at))
                    capture.saturates_at = photograph.saturates_at;
                // As the run read it: a map of its pixels is of these.
                capture.raw_half = is_raw_suffix(file);
                captures.captures.push_back(std::move(capture));
            }
        }
    }
    write_captures_manifest(captures);
}

void Recording::take_again(std::size_t place) {
    check_argument(place < showings_.size(), "a picture that was not shown");
    const std::lock_guard lock(mutex_);
    showings_[place].photographs.clear();
    showings_[place].measured.clear();
}

std::vector<RecordedShowing> Recording::showings() const {
    const std::lock_guard lock(mutex_);
    return showings_;
}

}  // namespace livery
