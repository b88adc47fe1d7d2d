#include "desktop/prepared.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "cli/render/frame_options.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "live/projector_setup.h"
#include "live/vote_frames.h"
#include "scene/frame_plan.h"
#include "scene/library.h"
#include "session/commands.h"
#include "session/look_exchange.h"
#include "session/session.h"
#include "support/temporary_folder.h"
#include "twin/bench.h"

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

fs::path prepared_calibration(glm::ivec2 projector_px) {
    const CacheLock lock;
    // The folder's name is in this file once the calibration is complete.
    const fs::path done =
        cache_folder() / fmt::format("calibration-{}x{}", projector_px.x, projector_px.y);
    if (!fs::exists(done)) {
        const auto product =
            std::make_shared<const Product>(load_product(shipped_path("assets/car.json")));
        BenchDescription description = read_bench_file("default");
        View &projector = description.projector.view, &camera = description.camera.view;
        const double scale = static_cast<double>(projector_px.x) / projector.width;
        projector = resized(projector, projector_px.x, projector_px.y);
        camera = resized(camera,
                         static_cast<int>(std::lround(scale * camera.width)),
                         static_cast<int>(std::lround(scale * camera.height)));
        Bench bench(description, product);
        write_text_file(done, calibrate_on_bench(bench, product, {}).string());
    }
    return read_text_file(done);
}

Document prepare_session(const fs::path& file, Quality quality, glm::ivec2 projector_px) {
    Session session = Session::open(file);
    session.execute(SetQuality{quality});
    session.execute(SetCalibration{prepared_calibration(projector_px).string()});
    return session.document();
}

namespace {

/// What `livery render` draws of a look.
RenderedFrame rendered(const Document& document, int look_id, const std::string& stage) {
    const TemporaryFolder folder;
    FrameArguments arguments;
    arguments.look = (folder / "look.json").string();
    export_look(document, look_id, arguments.look);
    arguments.calibration = document.calibration;
    arguments.quality = to_string(document.quality);
    arguments.eye =
        fmt::format("{},{},{}", document.eye_mm.x, document.eye_mm.y, document.eye_mm.z);
    arguments.design_white = document.design_white_percentile;
    arguments.gamut = to_string(document.gamut_mapping);
    arguments.stage = stage;
    ResolvedFrame frame = resolve_frame(arguments, {});
    frame.request.compensation = &frame.compensation.value();
    return render_frame(frame.request);
}

}  // namespace

Image8 expected_drive(const Document& document, int look_id) {
    // Most tests begin with the same look. Files that a document names do not change meanwhile.
    static std::map<std::string, Image8> drawn;
    Document shown = document;
    std::erase_if(shown.looks, [&](const SessionLook& one) { return one.id != look_id; });
    const std::string key = text_of(shown);
    if (!drawn.contains(key)) drawn[key] = rendered(document, look_id, "projector").drive;
    return drawn[key];
}

Image8 expected_grey(const Document& document, int look_id) {
    const ImageF wanted = rendered(document, look_id, "radiance").radiance_working;
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
