#include "desktop/prepared.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/colour.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "live/projector_setup.h"
#include "live/vote_frames.h"
#include "scene/frame_plan.h"
#include "session/commands.h"
#include "session/look_exchange.h"
#include "session/session.h"
#include "support/run_program.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

/// Several test programs may run at once: what they share is made by one of them.
class CacheLock {
  public:
    CacheLock() {
        fs::create_directories(LIVERY_TEST_CACHE);
        file_ = ::open(LIVERY_TEST_CACHE "/lock", O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (file_ < 0 || ::flock(file_, LOCK_EX) != 0) {
            throw std::runtime_error("cannot lock " LIVERY_TEST_CACHE);
        }
    }
    ~CacheLock() { ::close(file_); }
    CacheLock(const CacheLock&) = delete;
    CacheLock& operator=(const CacheLock&) = delete;

  private:
    int file_ = -1;
};

/// Results of this build of the program; those of others are swept away. Under the lock.
fs::path cache_folder() {
    const auto built = fs::last_write_time(LIVERY_PROGRAM).time_since_epoch().count();
    const fs::path all = LIVERY_TEST_CACHE, folder = all / std::to_string(built);
    if (!fs::exists(folder)) {
        for (const auto& entry : fs::directory_iterator(all)) {
            if (entry.is_directory()) fs::remove_all(entry);
        }
        fs::create_directories(folder);
    }
    // Calibrations and swatches are kept there as well.
    ::setenv("LIVERY_HOME", (folder / "home").c_str(), 1);
    return folder;
}

std::string hash_of(const std::string& text) {
    Hasher hasher;
    hasher.add(text);
    return hasher.hex();
}

}  // namespace

Image8 read_png(const fs::path& file) {
    const ImageF image = read_image(file).image;
    Image8 picture(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) = static_cast<std::uint8_t>(std::lround(image.at(x, y, c)));
            }
        }
    }
    return picture;
}

fs::path prepared_calibration() {
    const CacheLock lock;
    // The folder's name is in this file once the calibration is complete.
    const fs::path done = cache_folder() / "calibration";
    if (!fs::exists(done)) {
        const auto product =
            std::make_shared<const Product>(load_product(shipped_path("assets/car.json")));
        const fs::path folder = calibrate_on_bench("default", product, {});
        write_text_file(done, folder.string());
    }
    return read_text_file(done);
}

Document prepare_session(const fs::path& file, Quality quality) {
    Session session = Session::open(file);
    session.execute(SetQuality{quality});
    session.execute(SetCalibration{prepared_calibration().string()});
    return session.document();
}

namespace {

/// What the command line draws of a look, kept with the build; the picture's file.
fs::path rendered(const Document& document,
                  int look_id,
                  const std::string& stage,
                  const std::string& suffix) {
    const TemporaryFolder folder;
    const fs::path look_file = folder / "look.json";
    const auto files = export_look(document, look_id, look_file);
    const std::vector<std::string> options = {
        "--calibration",
        document.calibration,
        "--quality",
        to_string(document.quality),
        "--eye",
        fmt::format("{},{},{}", document.eye_mm.x, document.eye_mm.y, document.eye_mm.z),
        "--design-white",
        fmt::format("{}", document.design_white_percentile),
        "--gamut",
        to_string(document.gamut_mapping)};
    std::string key = stage;
    for (const auto& file : files) key += read_text_file(file);
    for (const auto& option : options) key += option;
    const CacheLock lock;
    const fs::path picture = cache_folder() / (hash_of(key) + suffix);
    if (!fs::exists(picture)) {
        std::vector<std::string> arguments = {
            "render", "--stage", stage, "--look", look_file.string(), "--out", picture.string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProgramRun run = run_program(LIVERY_PROGRAM, arguments);
        if (run.exit_code != 0) throw std::runtime_error("livery render: " + run.err);
    }
    return picture;
}

}  // namespace

Image8 expected_drive(const Document& document, int look_id) {
    return read_png(rendered(document, look_id, "projector", ".png"));
}

Image8 expected_grey(const Document& document, int look_id) {
    ImageF wanted = read_image(rendered(document, look_id, "radiance", ".exr")).image;
    // The file has Rec.709 over black.
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        float* v = &wanted.values[4 * i];
        if (v[3] <= 0.0f) continue;
        const glm::dvec3 working =
            working_from_rec709() * (glm::dvec3(v[0], v[1], v[2]) / static_cast<double>(v[3]));
        for (int c = 0; c < 3; ++c) v[c] = static_cast<float>(working[c]);
    }
    const Product product = load_product(shipped_path("assets/car.json"));
    const auto setup = load_setup(document.calibration,
                                  document.design_white_percentile,
                                  product.mesh,
                                  document.gamut_mapping);
    return neutral_drive(wanted, mean_luminance(wanted), *setup);
}

Image8 expected_drive(Document document,
                      int look_id,
                      const std::string& part,
                      const std::string& paint) {
    return expected_drive(applied(document, SetPaint{look_id, part, paint}), look_id);
}

}  // namespace livery
