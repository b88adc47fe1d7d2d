// docs/walkthrough-folders.md as it stands: its commands in their order, in an empty folder, with
// the photographs that the page asks its reader for taken on the simulated bench.
#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/support/board_photographs.h"
#include "capture/patterns_folder.h"
#include "cli/livery_run.h"
#include "core/colour.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/statistics.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/comparison.h"
#include "mesh/ply_write.h"
#include "scene/library.h"
#include "scene/product.h"
#include "support/dng.h"
#include "support/temporary_folder.h"
#include "twin/bench.h"

namespace livery {
namespace {

const std::filesystem::path kPage = LIVERY_SOURCE "/docs/walkthrough-folders.md";
/// What the page has for its reader's projector, and what the bench has.
constexpr std::string_view kPagesProjector = "1280x800";
constexpr int kWidth = 480, kHeight = 300;
constexpr double kSquare_mm = 15.0;
const ExposureSettings kExposed{1.0 / 15.0, 8.0, 100.0};

/// The default bench with few pixels.
BenchDescription small_bench() {
    BenchDescription bench = read_bench_file("default");
    bench.projector.view = resized(bench.projector.view, kWidth, kHeight);
    bench.camera.view = resized(bench.camera.view, 432, 288);
    return bench;
}

/// Somebody with a still camera, which writes RAW files and how they were exposed.
class Photographer {
  public:
    Photographer() : description_(small_bench()) {}

    /// All of a folder of patterns, on a board in another pose each time.
    void board(const std::filesystem::path& patterns, const std::filesystem::path& into) {
        static const std::vector<glm::dvec3> turns{{0.45, 0.0, 0.05},
                                                   {-0.4, 0.1, 0.0},
                                                   {0.1, 0.5, -0.1},
                                                   {0.0, -0.45, 0.1},
                                                   {0.3, 0.35, 0.2}};
        testing::BoardScene scene;
        scene.camera = description_.camera.view;
        scene.projector = description_.projector.view;
        const Rigid3 world_from_camera = inverse(scene.camera.view_from_world);
        scene.projector.view_from_world = scene.projector.view_from_world * world_from_camera;
        // Where the mock-up will stand, facing half-way between camera and projector
        const glm::dvec3 middle = scene.camera.view_from_world * glm::dvec3(0.0, 30.0, 0.0);
        const glm::dvec3 facing = -glm::normalize(
            glm::normalize(-middle) +
            glm::normalize(inverse(scene.projector.view_from_world).translation - middle));
        const glm::dmat3 turned =
            rotation_of(turns.at(poses_++)) * rotation_between({0.0, 0.0, 1.0}, facing);
        scene.camera.view_from_world = {};
        scene.camera_from_board = {
            turned, middle - turned * glm::dvec3(4.0 * kSquare_mm, 3.0 * kSquare_mm, 0.0)};
        scene.reflectance = testing::chessboard(9, 7, kSquare_mm);
        scene.seed = static_cast<std::uint32_t>(poses_);
        std::map<std::string, ImageF> by_role;
        for (RoledPhotograph& one : testing::photographs_of(scene))
            by_role.emplace(one.role, std::move(one.photograph.image));
        std::filesystem::create_directory(into);
        for (const PatternEntry& shown : roles_of(patterns)) {
            const ImageF& seen = by_role.at(shown.role);
            write(into, seen.width, seen.height, 0, [&](int x, int y, int) {
                return 40'000.0f * std::max(seen.at(x, y), 0.0f);
            });
        }
    }

    /// The same on the mock-up, between table, wall and floor.
    void mockup(const std::filesystem::path& patterns, const std::filesystem::path& into) {
        if (!bench_) bench_.emplace(description_, find_product(description_.product.string()));
        const BenchPorts ports = bench_->ports();
        std::filesystem::create_directory(into);
        for (const PatternEntry& shown : roles_of(patterns)) {
            ports.show(read_pattern(patterns / shown.file, kWidth, kHeight));
            const Photograph seen = ports.photograph(bench_->default_exposure_s());
            write(into,
                  seen.image.width,
                  seen.image.height,
                  static_cast<std::uint32_t>(4.0 * seen.black_level),
                  [&](int x, int y, int channel) { return 4.0f * seen.image.at(x, y, channel); });
        }
    }

    /// After a photograph of the mock-up.
    const Bench& bench() const { return bench_.value(); }

  private:
    static std::vector<PatternEntry> roles_of(const std::filesystem::path& patterns) {
        return read_patterns_manifest(patterns / "manifest.json").patterns;
    }
    /// Each pixel as a square of the sensor's colour filter.
    template <typename Value>
    void write(const std::filesystem::path& into,
               int width,
               int height,
               std::uint32_t black,
               const Value& value) {
        const auto sample = [&](int x, int y) {
            const int channel = x % 2 != y % 2 ? 1 : x % 2 == 1 ? 2 : 0;
            return static_cast<std::uint16_t>(std::min(value(x / 2, y / 2, channel), 65535.0f));
        };
        write_text_file(into / fmt::format("DSC_{:04}.DNG", ++photographs_),
                        testing::dng_of(2 * width, 2 * height, black, sample, kExposed));
    }

    BenchDescription description_;
    std::optional<Bench> bench_;
    std::size_t poses_ = 0, photographs_ = 0;
};

/// The lines of the page's code blocks.
std::vector<std::string> commands_of(const std::string& page) {
    std::vector<std::string> commands;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("    ")) commands.push_back(line.substr(4));
    return commands;
}

std::vector<std::string> words_of(const std::string& command) {
    std::istringstream stream(command);
    return {std::istream_iterator<std::string>(stream), {}};
}

/// The file that the page has its reader save.
std::string file_in(const std::string& page) {
    const std::string_view open = "```json\n";
    const std::size_t from = page.find(open) + open.size();
    return page.substr(from, page.find("```", from) - from);
}

/// How far what the observer sees of a picture is from what was wanted, but for its brightness: the
/// median of CIEDE2000 over what the projector lights of the mock-up.
double colour_error(const Bench& bench, const Image8& input, const ImageF& wanted) {
    const ImageF seen = bench.observe_xyz(input);
    std::vector<glm::dvec3> seen_xyz, wanted_xyz;
    double seen_y = 0.0, wanted_y = 0.0;
    for (std::size_t i = 0; i < input.pixel_count(); ++i) {
        const float *rgb = &wanted.values[4 * i], *xyz = &seen.values[3 * i];
        if (rgb[3] < 0.999f || input.values[3 * i + 1] == 0 || bench.truth().edge.values[i])
            continue;
        wanted_xyz.push_back(xyz_from_rec709() * glm::dvec3(rgb[0], rgb[1], rgb[2]));
        seen_xyz.emplace_back(xyz[0], xyz[1], xyz[2]);
        wanted_y += wanted_xyz.back().y;
        seen_y += seen_xyz.back().y;
    }
    const glm::dvec3 white = xyz_from_rec709() * glm::dvec3(1.0);
    std::vector<double> errors;
    for (std::size_t i = 0; i < seen_xyz.size(); ++i)
        errors.push_back(ciede2000(lab_from_xyz(seen_xyz[i] * (wanted_y / seen_y), white),
                                   lab_from_xyz(wanted_xyz[i], white)));
    return median(errors);
}

TEST(Walkthrough, OfFoldersIsAsItsPageSays) {
    const TemporaryFolder folder;
    const std::string page = read_text_file(kPage);
    // What its reader has before.
    const std::shared_ptr<const Product> car = find_product("car");
    folder.write("mockup.ply", ply_bytes(car->mesh));
    folder.write("camera-to-xyz.json", file_in(page));
    Photographer photographer;
    std::vector<std::string> done;
    for (std::string command : commands_of(page)) {
        SCOPED_TRACE(command);
        ASSERT_TRUE(command.starts_with("livery ")) << "only commands stand in its blocks";
        if (const auto at = command.find(kPagesProjector); at != std::string::npos)
            command.replace(at, kPagesProjector.size(), fmt::format("{}x{}", kWidth, kHeight));
        const std::vector<std::string> words = words_of(command);
        // The photographs that the text before it asks for
        for (const std::string& captures : words) {
            const bool board = captures.starts_with("pose-");
            if ((!board && captures != "captures") || std::filesystem::exists(folder / captures))
                continue;
            const auto shown = std::find(words.begin(), words.end(), "--patterns");
            ASSERT_TRUE(shown != words.end());
            ASSERT_NE(page.find("`" + captures + "`"), std::string::npos) << captures;
            if (board) {
                photographer.board(folder / *std::next(shown), folder / captures);
            } else {
                photographer.mockup(folder / *std::next(shown), folder / captures);
            }
        }
        const ProgramRun run =
            run_program("/bin/sh",
                        {"-c",
                         "cd '" + folder.path().string() + "' && exec '" LIVERY_PROGRAM "'" +
                             command.substr(std::string_view("livery").size())});
        ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
        std::printf("    %s\n%s", command.c_str(), run.out.c_str());
        done.push_back(words[1] + (words[1] == "calibrate" ? " " + words[2] : ""));
    }
    EXPECT_EQ(done,
              (std::vector<std::string>{"board",
                                        "patterns",
                                        "check",
                                        "calibrate geometry",
                                        "patterns",
                                        "check",
                                        "calibrate register",
                                        "calibrate scan",
                                        "calibrate color",
                                        "render",
                                        "compensate"}));

    // The picture lies on the mock-up, and nowhere else.
    const Bench& bench = photographer.bench();
    const ErrorStatistics off = picture_offset(bench.description().projector.view,
                                               car->mesh,
                                               projector_view_of(folder / "calibration").value(),
                                               car->mesh,
                                               bench.truth().lit);
    std::printf("    picture off its place %.3f / %.3f px\n", off.median, off.p95);
    EXPECT_LT(off.median, 0.5);
    EXPECT_LT(off.p95, 1.0);
    const Image8 input = read_pattern(folder / "input.png", kWidth, kHeight);
    const ImageF wanted = read_image(folder / "wanted.exr").image;
    std::size_t covered = 0, lit = 0, spilt = 0;
    for (std::size_t i = 0; i < input.pixel_count(); ++i) {
        const bool bright = input.values[3 * i + 2] > 20;
        const bool inside = wanted.values[4 * i + 3] >= 0.5f;
        covered += inside;
        lit += inside && bright;
        spilt += !inside && bright;
    }
    EXPECT_GT(static_cast<double>(lit), 0.9 * static_cast<double>(covered));
    EXPECT_EQ(spilt, 0u);
    // As near as the bench's lamp is to the light that the page says a projector sends.
    const double error = colour_error(bench, input, wanted);
    std::printf("    CIEDE2000 %.2f in the median, but for brightness\n", error);
    EXPECT_LT(error, 7.0);
}

}  // namespace
}  // namespace livery
