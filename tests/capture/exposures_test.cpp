// Exposures that a folder's manifest leaves to the photographs' own EXIF.
#include "capture/exposures.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "capture/stand_folders.h"
#include "core/image_io.h"
#include "core/pictures/exposure_settings.h"
#include "support/dng.h"
#include "support/exif.h"
#include "support/file_error.h"
#include "support/jpeg.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::dng_of;
using testing::jpeg_of;
using testing::tiff_of;
using testing::with_exif;

class Exposures : public ::testing::Test {
  protected:
    void jpeg(const std::string& name, const ExposureSettings& said) {
        folder_.write(name, with_exif(jpeg_of(Image8(8, 8, 3, 90)), said));
    }
    void tiff(const std::string& name, const ExposureSettings& said) {
        folder_.write(name, tiff_of(Image16(8, 8, 3, 9000), said));
    }
    void dng(const std::string& name, const ExposureSettings& said) {
        folder_.write(name,
                      dng_of(
                          64, 64, 0, [](int, int) { return 9000; }, said));
    }
    /// Of white, black and the colours, a file each; `more` of each entry, nothing where it is "".
    void manifest(const std::vector<std::string>& files,
                  const std::vector<std::string>& more = {},
                  const std::string& of_all = "") {
        const char* roles[] = {"white", "black", "red", "green", "blue"};
        std::string text;
        for (std::size_t k = 0; k < files.size(); ++k) {
            text += std::string(k == 0 ? "" : ", ") + R"({"file": ")" + files[k] +
                    R"(", "role": ")" + roles[k] + "\"";
            if (k < more.size() && !more[k].empty()) text += ", \"exposure_s\": " + more[k];
            text += "}";
        }
        folder_.write("manifest.json",
                      "{\"projector\": [8, 6], " + of_all + "\"captures\": [" + text + "]}");
    }
    std::vector<double> read(PhotographUse use) const {
        std::vector<double> exposures;
        for (const Capture& one : read_captures_folder(folder_.path(), use).captures)
            exposures.push_back(one.exposure_s);
        return exposures;
    }
    ::testing::AssertionResult fails(PhotographUse use,
                                     std::initializer_list<std::string_view> parts) const {
        return fails_with([&] { read(use); }, parts);
    }

    TemporaryFolder folder_;
};

TEST_F(Exposures, ComeFromTheFilesWhereTheManifestSaysNothing) {
    jpeg("a.jpg", {1.0 / 60.0, 8.0, 200.0});
    tiff("b.tif", {1.0 / 30.0, 8.0, 200.0});
    dng("c.dng", {2.0, 8.0, 200.0});
    for (const char* name : {"a.jpg", "b.tif", "c.dng"})
        EXPECT_EQ(read_exposure_settings(folder_ / name), read_image(folder_ / name).settings);
    manifest({"a.jpg", "b.tif", "c.dng"}, {"", "null", ""});
    for (const PhotographUse use : {PhotographUse::light, PhotographUse::places}) {
        const std::vector<double> exposures = read(use);
        ASSERT_EQ(exposures.size(), 3u);
        EXPECT_NEAR(exposures[0], 1.0 / 60.0, 1e-6);
        EXPECT_NEAR(exposures[1], 1.0 / 30.0, 1e-6);
        EXPECT_NEAR(exposures[2], 2.0, 1e-6);
    }
    // What is stated counts, of an entry before what is said of all.
    manifest({"a.jpg", "b.tif", "c.dng"}, {"0.5", "null", ""}, "\"exposure_s\": 0.25, ");
    EXPECT_EQ(read(PhotographUse::light), (std::vector<double>{0.5, 0.25, 0.25}));
    manifest({"a.jpg", "b.tif"}, {"0.5", "\"soon\""});
    EXPECT_TRUE(fails(PhotographUse::places, {"captures[1].exposure_s", "soon", "a number"}));
}

TEST_F(Exposures, AreNotAskedForWherePlacesAreWanted) {
    write_png(folder_ / "a.png", Image8(8, 8, 3, 90));
    write_png(folder_ / "b.png", Image8(8, 8, 3, 9));
    jpeg("c.jpg", {0.1, 8.0, 200.0});
    jpeg("d.jpg", {0.4, 8.0, 200.0});
    manifest({"a.png", "b.png"});
    EXPECT_EQ(read(PhotographUse::places), (std::vector<double>{1.0, 1.0}));
    EXPECT_TRUE(fails(PhotographUse::light,
                      {"manifest.json",
                       "captures[0].exposure_s",
                       "nothing",
                       "no exposure time in the EXIF of a.png (nor of 1 others)",
                       "fill in exposure_s"}));
    // Those that say nothing are like the others, unless the others differ.
    manifest({"a.png", "b.png"}, {"", "0.5"});
    EXPECT_EQ(read(PhotographUse::places), (std::vector<double>{0.5, 0.5}));
    EXPECT_TRUE(fails(PhotographUse::light, {"captures[0].exposure_s", "EXIF of a.png, expected"}));
    manifest({"c.jpg", "b.png"});
    EXPECT_NEAR(read(PhotographUse::places)[1], 0.1, 1e-7);
    manifest({"c.jpg", "b.png", "d.jpg"});
    EXPECT_TRUE(fails(PhotographUse::places, {"captures[1].exposure_s", "EXIF of b.png"}));
}

TEST_F(Exposures, OfAnotherIsoOrApertureAreRefusedByName) {
    jpeg("a.jpg", {0.1, 8.0, 200.0});
    jpeg("b.jpg", {0.4, 8.0, 200.0});
    jpeg("c.jpg", {0.1, 8.0, 800.0});
    tiff("d.tif", {0.1, 5.6, 0.0});  // a TIFF's ISO is not read
    tiff("e.tif", {0.1, 8.0, 0.0});
    write_png(folder_ / "f.png", Image8(8, 8, 3, 90));
    const auto why = [&](PhotographUse use) { return message_of([&] { read(use); }); };
    manifest({"a.jpg", "b.jpg", "e.tif"});
    EXPECT_EQ(why(PhotographUse::light), "nothing thrown");
    for (const PhotographUse use : {PhotographUse::light, PhotographUse::places}) {
        // Seconds that are stated make no difference.
        manifest({"c.jpg", "a.jpg", "b.jpg", "d.tif", "f.png"}, {"", "1", "", "", "1"});
        EXPECT_THROW(read(use), Refused);
        for (const char* part : {"c.jpg (f/8, ISO 800), d.tif (f/5.6)",
                                 "than the others (f/8, ISO 200)",
                                 "automatic ISO off"})
            EXPECT_NE(why(use).find(part), std::string::npos) << why(use);
        EXPECT_EQ(why(use).find("b.jpg"), std::string::npos) << why(use);
    }
}

TEST_F(Exposures, WithoutAManifestAreThoseOfTheFiles) {
    const TemporaryFolder shown;
    const std::string text =
        R"({"projector": [8, 6], "captures": [{"pattern": "000.png", "role": "white"},
           {"pattern": "001.png", "role": "black"}]})";
    shown.write("manifest.json", text);
    jpeg("a.jpg", {0.1, 8.0, 200.0});
    jpeg("b.JPG", {0.4, 8.0, 200.0});
    // The folder of the patterns will do for its manifest.
    for (const auto& patterns : {shown / "manifest.json", shown.path()}) {
        const CapturesFolder read =
            read_captures_folder(folder_.path(), PhotographUse::light, patterns);
        ASSERT_EQ(read.captures.size(), 2u);
        EXPECT_EQ(read.captures[0].role, "white");
        EXPECT_NEAR(read.captures[1].exposure_s, 0.4, 1e-7);
        EXPECT_EQ(read.captures[0].transfer, "srgb");  // a camera's JPEG
        EXPECT_EQ(read.captures[1].transfer, "srgb");
    }
    const auto light = [&] {
        return read_captures_folder(folder_.path(), PhotographUse::light, shown.path());
    };
    jpeg("b.JPG", {});
    EXPECT_TRUE(fails_with(light, {folder_.path().string(), "b.JPG", "no exposure time"}));
    jpeg("a.jpg", {});
    EXPECT_EQ(light().captures[1].exposure_s, 1.0);
}

TEST_F(Exposures, OfFilesThatCannotBeReadAreNotGuessed) {
    jpeg("a.jpg", {0.1, 8.0, 200.0});
    folder_.write("b.jpg", "no picture at all");
    manifest({"a.jpg", "b.jpg"});
    EXPECT_TRUE(fails(PhotographUse::light, {"b.jpg", "content of another kind"}));
    manifest({"a.jpg", "b.jpg"}, {"", "0.1"});
    EXPECT_EQ(read(PhotographUse::light).size(), 2u);  // whoever loads it says so
}

TEST_F(Exposures, OfMeasuringFoldersComeFromTheFilesToo) {
    jpeg("a.jpg", {0.1, 8.0, 200.0});
    jpeg("b.jpg", {0.4, 8.0, 200.0});
    folder_.write("manifest.json",
                  R"({"environment": "panorama", "captures": [{"file": "a.jpg"},
                     {"file": "b.jpg"}]})");
    EXPECT_NEAR(read_environment_folder(folder_.path()).panorama.captures[1].exposure_s, 0.4, 1e-7);
    jpeg("b.jpg", {});
    EXPECT_TRUE(fails_with([&] { read_environment_folder(folder_.path()); },
                           {"captures[1].exposure_s", "EXIF of b.jpg"}));
}

}  // namespace
}  // namespace livery
