#include "capture/recording.h"

#include <gtest/gtest.h>

#include "capture/captures_folder.h"
#include "core/error.h"
#include "core/paths.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Image8 picture(int level) { return Image8(8, 4, 3, static_cast<std::uint8_t>(level)); }

/// A camera that sees the picture's level, its own number and the exposure.
struct CountingBench {
    int shown = 0, photographs = 0, pictures = 0;

    BenchPorts ports() {
        BenchPorts ports;
        ports.show = [this](const Image8& drive) {
            shown = drive.values.front();
            ++pictures;
        };
        ports.photograph = [this](double exposure_s) {
            Photograph photograph;
            photograph.image = ImageF(4, 2, 3, static_cast<float>(shown));
            photograph.image.values[0] = 0.1f + static_cast<float>(photographs++);
            photograph.exposure_s = exposure_s > 0.0 ? exposure_s : 0.25;
            photograph.black_level = 3.0;
            photograph.saturates_at = 1000.0;
            return photograph;
        };
        return ports;
    }
};

/// Three pictures, two photographs each; the second at another exposure.
std::vector<Photograph> run(const BenchPorts& ports, int pictures = 3, int photographs = 2) {
    std::vector<Photograph> taken;
    for (int k = 0; k < pictures; ++k) {
        ports.announce("picture " + std::to_string(k));
        ports.show(picture(10 * k));
        for (int i = 0; i < photographs; ++i) taken.push_back(ports.photograph(i == 0 ? 0.0 : 0.5));
    }
    return taken;
}

void expect_same(const std::vector<Photograph>& a, const std::vector<Photograph>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].image.values, b[k].image.values) << k;
        EXPECT_EQ(a[k].exposure_s, b[k].exposure_s) << k;
        EXPECT_EQ(a[k].black_level, b[k].black_level) << k;
        EXPECT_EQ(a[k].saturates_at, b[k].saturates_at) << k;
    }
}

TEST(Recording, AnswersTheSameRunWithoutACamera) {
    const TemporaryFolder folder;
    CountingBench bench;
    std::vector<Photograph> first;
    {
        Recording recording(folder.path(), "bench");
        first = run(recording.ports(bench.ports()));
        EXPECT_EQ(recording.taken(), 6);
        EXPECT_EQ(first[1].kept_as, std::vector<std::string>{"0001.exr"});
    }
    Recording replay(folder.path(), "bench");
    expect_same(run(replay.ports({})), first);
    EXPECT_EQ(replay.answered(), 6);
    EXPECT_EQ(bench.photographs, 6);
    EXPECT_EQ(replay.showings()[2].photographs[0].of, "picture 2");
}

TEST(Recording, GoesOnWhereItStopped) {
    const TemporaryFolder folder;
    CountingBench bench;
    {
        Recording recording(folder.path(), "bench");
        run(recording.ports(bench.ports()), 2);
    }
    Recording recording(folder.path(), "bench");
    const int shown_before = bench.pictures;
    const auto all = run(recording.ports(bench.ports()));
    EXPECT_EQ(recording.answered(), 4);
    EXPECT_EQ(recording.taken(), 2);
    EXPECT_EQ(bench.pictures, shown_before + 1) << "what is known is not shown again";
    EXPECT_EQ(all[4].image.values[1], 20.0f);
    EXPECT_EQ(all[4].kept_as, std::vector<std::string>{"0004.exr"}) << "nothing is written over";
}

TEST(Recording, ShowsAPictureAnewInTheMiddleOfItsPhotographs) {
    const TemporaryFolder folder;
    CountingBench bench;
    {
        Recording recording(folder.path(), "bench");
        run(recording.ports(bench.ports()), 2, 1);
    }
    Recording recording(folder.path(), "bench");
    const int photographs_before = bench.photographs;
    const auto all = run(recording.ports(bench.ports()), 2, 2);
    EXPECT_EQ(recording.taken(), 2);
    // Not known how late this projector is: some are thrown away before each.
    EXPECT_EQ(bench.photographs - photographs_before, 2 + 2 * 6);
    EXPECT_EQ(all[1].image.values[1], 0.0f);
    EXPECT_EQ(all[3].image.values[1], 10.0f);
}

TEST(Recording, LosesWhatWasNotWritten) {
    const TemporaryFolder folder;
    CountingBench bench;
    {
        Recording recording(folder.path(), "bench");
        run(recording.ports(bench.ports()));
    }
    // Killed while 0006 was written: the list does not name it.
    write_text_file(folder.path() / "0006.exr", "half of a picture");
    Recording recording(folder.path(), "bench");
    EXPECT_EQ(run(recording.ports(bench.ports()), 4).size(), 8u);
    EXPECT_EQ(recording.answered(), 6);
    EXPECT_EQ(load_photograph({"", folder.path() / "0006.exr", "", {}, 1.0}).image.values[1],
              30.0f);
}

TEST(Recording, TakesOnePictureAgain) {
    const TemporaryFolder folder;
    CountingBench bench;
    std::vector<Photograph> first;
    {
        Recording recording(folder.path(), "bench");
        first = run(recording.ports(bench.ports()));
    }
    Recording recording(folder.path(), "bench");
    recording.take_again(1);
    const auto second = run(recording.ports(bench.ports()));
    EXPECT_EQ(recording.taken(), 2);
    EXPECT_EQ(recording.answered(), 4);
    EXPECT_EQ(second[1].image.values, first[1].image.values);
    EXPECT_NE(second[2].image.values, first[2].image.values);
    EXPECT_EQ(second[4].image.values, first[4].image.values);
    recording.flush();
    Recording replay(folder.path(), "bench");
    expect_same(run(replay.ports({})), second);
    EXPECT_THROW(recording.take_again(3), std::invalid_argument);
}

TEST(Recording, TakesWhatIsAskedForOtherwise) {
    const TemporaryFolder folder;
    CountingBench bench;
    Recording recording(folder.path(), "bench");
    run(recording.ports(bench.ports()));
    const BenchPorts ports = recording.ports(bench.ports());
    ports.show(picture(0));
    ports.photograph(0.125);
    EXPECT_EQ(recording.taken(), 7);
    EXPECT_EQ(recording.showings()[0].photographs.size(), 1u);
    ports.show(picture(99));
    ports.photograph(0.0);
    ports.show(picture(20));  // What lies between is passed over, and kept.
    ports.photograph(0.0);
    EXPECT_EQ(recording.answered(), 1);
    EXPECT_EQ(recording.showings().size(), 4u);
}

TEST(Recording, KeepsACamerasOwnFileAndMeasurements) {
    const TemporaryFolder folder;
    CountingBench bench;
    const std::string bytes("RAW\0 and more\n", 14);
    int measured = 0;
    BenchPorts live = bench.ports();
    live.photograph = [take = live.photograph, &bytes](double exposure_s) {
        Photograph photograph = take(exposure_s);
        photograph.file =
            std::make_shared<CameraFile>(CameraFile{"DSC_0001.NEF", {bytes.begin(), bytes.end()}});
        return photograph;
    };
    live.measure_xyz = [&measured](glm::dvec2 place) {
        return glm::dvec3(place.x, place.y, 0.1 + measured++);
    };
    {
        Recording recording(folder.path(), "bench");
        const BenchPorts ports = recording.ports(live);
        ports.show(picture(10));
        ports.photograph(0.0);
        EXPECT_EQ(ports.measure_xyz({3.5, 4.5}).z, 0.1);
        ports.photograph(0.0);
    }
    EXPECT_EQ(read_text_file(folder.path() / "0000.NEF"), bytes);
    Recording replay(folder.path(), "bench");
    BenchPorts none;
    none.measure_xyz = [](glm::dvec2) -> glm::dvec3 { throw std::runtime_error("no colorimeter"); };
    const BenchPorts ports = replay.ports(none);
    ports.show(picture(10));
    EXPECT_EQ(ports.measure_xyz({3.5, 4.5}), glm::dvec3(3.5, 4.5, 0.1));
}

TEST(Recording, BecomesACapturesFolder) {
    const TemporaryFolder folder;
    CountingBench bench;
    Recording recording(folder.path(), "bench");
    run(recording.ports(bench.ports()));
    recording.write_manifest(
        8, 4, {{"white", "0003.exr"}, {"white", "0005.exr"}, {"red", "0000.exr"}});
    const CapturesFolder read = read_captures_folder(folder.path(), PhotographUse::light);
    EXPECT_EQ(read.projector_width, 8);
    ASSERT_EQ(read.captures.size(), 3u);
    EXPECT_EQ(read.captures[0].role, "white");
    EXPECT_EQ(read.captures[0].exposure_s, 0.5);
    EXPECT_EQ(read.captures[2].black_level, 3.0);
    EXPECT_EQ(load_photograph(read.captures[1]).image.values[1], 20.0f);
    EXPECT_EQ(load_photograph(read.captures[1]).saturates_at, 1000.0);
}

TEST(Recording, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    CountingBench bench;
    {
        Recording recording(folder.path(), "camera A");
        run(recording.ports(bench.ports()));
    }
    EXPECT_THROW(Recording(folder.path(), "camera B"), Refused);
    Recording replay(folder.path(), "camera A");
    const BenchPorts ports = replay.ports({});
    ports.announce("gray-row-3");
    ports.show(picture(77));
    EXPECT_EQ(message_of([&] { ports.photograph(0.0); }),
              folder.path().string() +
                  ": photographs: found none of gray-row-3 at 0 s in its place, expected a "
                  "recording of the whole run");
    std::filesystem::remove(folder.path() / "0002.exr");
    ports.show(picture(10));
    EXPECT_THROW(ports.photograph(0.0), FileError) << "ports were not asked for anew";
    for (const char* text : {"",
                             "{",
                             "[]",
                             "{\"format_version\": 99}",
                             R"({"format_version": 1, "bench": "camera A", "showings": [{"picture":
                             "x", "photographs": [{"file": "../a.exr", "of": "", "asked_s": 0,
                             "exposure_s": 1, "black_level": 0}]}]})"}) {
        write_text_file(folder.path() / "recording.json", text);
        EXPECT_THROW(Recording(folder.path(), "camera A"), FileError) << text;
    }
}

/// Nor on from one that leaves no number after it.
TEST(Recording, IsNumberedOnFromTheHighestOfItsFiles) {
    for (const auto& [known, next] : {std::pair("0041.exr", "0042.exr"),
                                      std::pair("2147483647.exr", "0000.exr"),
                                      std::pair("99999999999.exr", "0000.exr"),
                                      std::pair("-8.exr", "0000.exr")}) {
        const TemporaryFolder folder;
        write_text_file(folder.path() / "recording.json",
                        std::string(R"({"format_version": 1, "bench": "b", "showings": [
                            {"picture": "x", "photographs": [{"file": ")") +
                            known +
                            R"(", "of": "", "asked_s": 0, "exposure_s": 1, "black_level": 0}]}]})");
        CountingBench bench;
        Recording recording(folder.path(), "b");
        EXPECT_EQ(run(recording.ports(bench.ports()), 1, 1).front().kept_as,
                  std::vector<std::string>{next})
            << known;
    }
}

}  // namespace
}  // namespace livery
