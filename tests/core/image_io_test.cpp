#include "core/image_io.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "core/random.h"
#include "support/dng.h"
#include "support/exif.h"
#include "support/file_error.h"
#include "support/jpeg.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using namespace std::string_literals;

template <typename T>
Image<T> noise(int width, int height, int channels, std::uint32_t count) {
    Image<T> image(width, height, channels);
    Random random(7);
    for (auto& value : image.values) value = static_cast<T>(random.below(count));
    return image;
}

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<char>(value >> static_cast<unsigned>(shift)));
    }
    return bytes;
}

std::uint32_t crc32(const std::string& bytes) {
    std::uint32_t crc = ~0u;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1u) ^ ((crc & 1u) ? 0xedb88320u : 0u);
    }
    return ~crc;
}

/// The names of a PNG's chunks, in order.
std::vector<std::string> png_chunks(const std::string& png) {
    std::vector<std::string> names;
    for (std::size_t at = 8; at + 8 <= png.size();) {
        std::uint32_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            length = length << 8u | static_cast<unsigned char>(png[at + k]);
        }
        names.push_back(png.substr(at + 4, 4));
        at += 12 + length;
    }
    return names;
}

/// A PNG that declares 8 bit RGB of a size and holds no pixels.
std::string png_header(std::uint32_t width, std::uint32_t height) {
    const std::string chunk = "IHDR" + big_endian(width) + big_endian(height) + "\x08\x02\0\0\0"s;
    std::string png = "\x89PNG\r\n\x1a\n" + big_endian(13) + chunk + big_endian(crc32(chunk));
    for (const char* name : {"IDAT", "IEND"}) png += big_endian(0) + name + big_endian(crc32(name));
    return png;
}

/// Puts a size over the data and display windows of an EXR that we wrote.
std::string exr_with_size(std::string exr, std::int32_t width, std::int32_t height) {
    for (const std::string& name : {"dataWindow\0"s, "displayWindow\0"s}) {
        const auto box = exr.find(name) + name.size() + "box2i\0"s.size() + 4;
        const std::int32_t max[2] = {width - 1, height - 1};
        std::memcpy(exr.data() + box + 8, max, sizeof max);
    }
    return exr;
}

TEST(ImageIo, PngKeepsEveryDeviceValue) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3}) {
        const auto image8 = noise<std::uint8_t>(37, 19, channels, 256);
        write_png(folder / "8.png", image8);
        const auto read8 = read_image(folder / "8.png");
        EXPECT_EQ(read8.full_scale, 255.0);
        EXPECT_FALSE(read8.floating_point);
        ASSERT_EQ(read8.image.channels, channels);
        ASSERT_EQ(read8.image.values.size(), image8.values.size());
        for (std::size_t k = 0; k < image8.values.size(); ++k) {
            ASSERT_EQ(read8.image.values[k], static_cast<float>(image8.values[k]));
        }
        const auto image16 = noise<std::uint16_t>(37, 19, channels, 65536);
        write_png(folder / "16.png", image16);
        const auto read16 = read_image(folder / "16.png");
        EXPECT_EQ(read16.full_scale, 65535.0);
        for (std::size_t k = 0; k < image16.values.size(); ++k) {
            ASSERT_EQ(read16.image.values[k], static_cast<float>(image16.values[k]));
        }
    }
}

TEST(ImageIo, PngCarriesNoColourSpace) {
    const TemporaryFolder folder;
    write_png(folder / "8.png", noise<std::uint8_t>(5, 4, 3, 256));
    write_png(folder / "16.png", noise<std::uint16_t>(5, 4, 3, 65536));
    for (const char* name : {"8.png", "16.png"}) {
        const auto chunks = png_chunks(read_text_file(folder / name));
        ASSERT_FALSE(chunks.empty());
        EXPECT_EQ(chunks.front(), "IHDR");
        EXPECT_EQ(chunks.back(), "IEND");
        for (const auto& chunk : chunks) {
            EXPECT_NE(chunk, "gAMA");
            EXPECT_NE(chunk, "sRGB");
            EXPECT_NE(chunk, "iCCP");
            EXPECT_NE(chunk, "cHRM");
        }
    }
}

TEST(ImageIo, ExrKeepsFloatsNanAndInfinity) {
    const TemporaryFolder folder;
    ImageF image(3, 2, 3);
    Random random(3);
    for (float& value : image.values) value = static_cast<float>(random.normal());
    image.at(1, 0, 2) = std::numeric_limits<float>::quiet_NaN();
    image.at(2, 1, 0) = -std::numeric_limits<float>::infinity();
    image.at(0, 1, 1) = 1e-40f;  // below half's and normal float's range
    write_exr(folder / "a.exr", image);
    const auto read = read_image(folder / "a.exr");
    EXPECT_TRUE(read.floating_point);
    EXPECT_EQ(read.full_scale, 1.0);
    EXPECT_EQ(read.channel_names, (std::vector<std::string>{"R", "G", "B"}));
    ASSERT_EQ(read.image.values.size(), image.values.size());
    EXPECT_EQ(
        std::memcmp(
            read.image.values.data(), image.values.data(), image.values.size() * sizeof(float)),
        0);
}

TEST(ImageIo, ExrChannelsStayWithTheirNames) {
    const TemporaryFolder folder;
    const auto value_of = [](const ImageFile& file, const std::string& name) {
        for (std::size_t c = 0; c < file.channel_names.size(); ++c) {
            if (file.channel_names[c] == name) return file.image.values[c];
        }
        return -1.0f;
    };
    ImageF two(1, 1, 2), three(1, 1, 3), one(1, 1, 1, 5.0f);
    two.values = {10.0f, 20.0f};
    three.values = {1.0f, 2.0f, 3.0f};

    // What was written blue first reads red first.
    write_exr(folder / "bgr.exr", three, {"B", "G", "R"});
    const auto bgr = read_image(folder / "bgr.exr");
    EXPECT_EQ(bgr.channel_names, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(bgr.image.values, (std::vector<float>{3.0f, 2.0f, 1.0f}));

    for (const auto& names : {std::vector<std::string>{"X", "Y"}, {"Y", "X"}, {"u", "a"}}) {
        write_exr(folder / "two.exr", two, names);
        const auto read = read_image(folder / "two.exr");
        EXPECT_EQ(value_of(read, names[0]), 10.0f);
        EXPECT_EQ(value_of(read, names[1]), 20.0f);
    }
    write_exr(folder / "xyz.exr", three, {"X", "Y", "Z"});
    EXPECT_EQ(read_image(folder / "xyz.exr").image.values, three.values);
    write_exr(folder / "y.exr", one);
    EXPECT_EQ(read_image(folder / "y.exr").channel_names, std::vector<std::string>{"Y"});
}

TEST(ImageIo, AlphaIsNotMultipliedIn) {
    const TemporaryFolder folder;
    ImageF image(1, 1, 4);
    image.values = {0.5f, 0.25f, 1.0f, 0.125f};
    write_exr(folder / "rgba.exr", image);
    EXPECT_EQ(read_image(folder / "rgba.exr").image.values, image.values);
}

TEST(ImageIo, RefusesWhatIsNotAPicture) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::filesystem::path& file, std::string_view found) {
        return fails_with([&] { read_image(file); }, {file.string(), found, "expected"});
    };
    EXPECT_TRUE(fails(folder / "no.png", "no such file"));
    EXPECT_TRUE(fails(folder.path(), "a folder"));
    EXPECT_TRUE(fails(folder.write("empty.exr", ""), "an empty file"));
    EXPECT_TRUE(fails(folder.write("text.png", "hello, I am a letter"), "content of another kind"));
    EXPECT_TRUE(fails(folder.write("short.png", "\x89PN"), "content of another kind"));
    EXPECT_TRUE(fails(folder.write("zero.exr", std::string(4000, '\0')), "another kind"));
}

TEST(ImageIo, RefusesTruncatedPictures) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", noise<std::uint8_t>(64, 64, 3, 256));
    write_exr(folder / "a.exr", ImageF(64, 64, 3, 0.5f));
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 16\n";
    for (int row = 0; row < 16; ++row) {
        hdr += "\x02\x02"s + "\0\x10"s;
        for (int c = 0; c < 4; ++c) hdr += "\x90\x40";
    }
    EXPECT_EQ(read_image(folder.write("a.hdr", hdr)).image.width, 16);
    for (const char* name : {"a.png", "a.exr", "a.hdr"}) {
        const std::string whole = read_text_file(folder / name);
        ASSERT_NO_THROW(read_image(folder / name));
        for (const double part : {0.05, 0.3, 0.6, 0.9}) {
            const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
            const auto file = folder.write("cut-"s + name, whole.substr(0, size));
            EXPECT_TRUE(fails_with([&] { read_image(file); }, {file.string(), "expected"}))
                << name << " cut to " << size << " bytes";
        }
    }
}

TEST(ImageIo, ReadsRadianceRunsAndLiteralsAsTheirFormatSays) {
    const TemporaryFolder folder;
    // Eight pixels: a run, then literals; exponents 128 (x 2^-8), 129, 0 (black).
    std::string row = "\x02\x02\x00\x08"s;
    row += "\x88\x80"s;                      // red: 128 everywhere
    row += "\x04\x00\x40\x80\xff\x84\x10"s;  // green: 0 64 128 255, 16 four times
    row += "\x88\x01"s;                      // blue: 1
    row += "\x83\x80\x83\x81\x02\x00\x00"s;  // exponents
    const std::string header = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";
    const ImageFile picture = read_image(folder.write("a.hdr", header + "-Y 2 +X 8\n" + row + row));
    ASSERT_EQ(picture.image.width, 8);
    ASSERT_EQ(picture.image.height, 2);
    EXPECT_TRUE(picture.floating_point);
    EXPECT_EQ(picture.channel_names, (std::vector<std::string>{"R", "G", "B"}));
    for (int y = 0; y < 2; ++y) {
        EXPECT_EQ(picture.image.at(0, y, 0), 0.5f);
        EXPECT_EQ(picture.image.at(1, y, 1), 0.25f);
        EXPECT_EQ(picture.image.at(3, y, 1), 255.0f / 128.0f);
        EXPECT_EQ(picture.image.at(5, y, 2), 1.0f / 128.0f);
        EXPECT_EQ(picture.image.at(6, y, 0), 0.0f);
    }
    // Flat pixels, as old writers leave them, are read as well.
    std::string flat = header + "-Y 1 +X 2\n" + "\x80\x40\x20\x81\x80\x40\x20\x82"s;
    EXPECT_EQ(read_image(folder.write("flat.hdr", flat)).image.at(1, 0, 0), 2.0f);
    // A run over the row's end, and another row's width
    for (const char* bad : {"\x02\x02\x00\x08\x89\x80", "\x02\x02\x00\x09\x88\x80"}) {
        const auto file = folder.write("bad.hdr", header + "-Y 1 +X 8\n" + std::string(bad, 6));
        EXPECT_TRUE(fails_with([&] { read_image(file); }, {file.string(), "expected"}));
    }
}

TEST(ImageIo, RefusesADamagedPng) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", noise<std::uint8_t>(64, 64, 3, 256));
    std::string png = read_text_file(folder / "a.png");
    png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x10);
    EXPECT_TRUE(fails_with([&] { read_image(folder.write("b.png", png)); },
                           {"b.png", "damaged at byte", "(IDAT)"}));
    // A damaged name is shown as one line all the same.
    png.replace(png.find("IDAT"), 4, "\n\xff\x1b!");
    EXPECT_TRUE(fails_with([&] { read_image(folder.write("c.png", png)); },
                           {"c.png", "damaged at byte", R"((???!))"}));
}

TEST(ImageIo, RefusesSizesBeforeAllocating) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::filesystem::path& file, std::string_view found) {
        return fails_with([&] { read_image(file); }, {file.string(), found});
    };
    EXPECT_TRUE(fails(folder.write("0.png", png_header(0, 5)), "expected"));
    EXPECT_TRUE(fails(folder.write("p1.png", png_header(900'000, 900'000)), "900000x900000"));
    EXPECT_TRUE(fails(folder.write("p2.png", png_header(9'000, 9'000)), "9000x9000"));
    EXPECT_TRUE(fails(folder.write("p3.png", png_header(0x7fffffff, 0x7fffffff)), "expected"));

    write_exr(folder / "a.exr", ImageF(4, 4, 3));
    const std::string exr = read_text_file(folder / "a.exr");
    EXPECT_TRUE(fails(folder.write("e1.exr", exr_with_size(exr, 0, 0)), "expected"));
    EXPECT_TRUE(fails(folder.write("e2.exr", exr_with_size(exr, 9'000, 9'000)), "expected"));
    EXPECT_TRUE(fails(folder.write("e3.exr", exr_with_size(exr, 1 << 30, 1 << 30)), "expected"));

    // Of what a small file declares, as much is believed as a quarter of a gigabyte holds.
    const std::string padded = exr + std::string(1u << 16u, '\0');
    EXPECT_TRUE(
        fails(folder.write("e4.exr", exr_with_size(padded, 8'000, 3'000)), "fits the file's"));
    EXPECT_TRUE(
        fails(folder.write("e5.exr", exr_with_size(padded, 9'900, 9'900)), "240000000 values"));

    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ";
    EXPECT_TRUE(fails(folder.write("h1.hdr", hdr + "0 +X 0\n"), "expected"));
    EXPECT_TRUE(fails(folder.write("h2.hdr", hdr + "9000 +X 9000\n"), "9000x9000"));
    EXPECT_TRUE(fails(folder.write("h3.hdr", hdr + "-7 +X 3\n"), "expected"));

    write_png(folder / "ok.png", Image8(20, 10, 1));
    EXPECT_TRUE(fails_with([&] { read_image(folder / "ok.png", 199); },
                           {"ok.png", "size", "20x10", "at most 199 pixels"}));
    EXPECT_NO_THROW(read_image(folder / "ok.png", 200));
}

TEST(ImageIo, RefusesACroppedExr) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", ImageF(4, 4, 1));
    std::string exr = read_text_file(folder / "a.exr");
    const auto box = exr.find("displayWindow\0"s) + "displayWindow\0box2i\0"s.size() + 4;
    const std::int32_t max[2] = {7, 7};
    std::memcpy(exr.data() + box + 8, max, sizeof max);
    EXPECT_TRUE(fails_with([&] { read_image(folder.write("crop.exr", exr)); },
                           {"crop.exr", "data window (4x4 at 0,0)", "(8x8 at 0,0)"}));
}

TEST(ImageIo, WritingSaysWhatIsWrong) {
    const TemporaryFolder folder;
    EXPECT_TRUE(fails_with([&] { write_png(folder / "no/a.png", Image8(2, 2, 3)); },
                           {"no/a.png", "No such file", "a writable place"}));
    EXPECT_TRUE(fails_with([&] { write_exr(folder.path(), ImageF(2, 2, 3)); },
                           {folder.path().string(), "a writable place"}));
    EXPECT_THROW(write_png(folder / "a.png", Image8(2, 2, 4)), std::invalid_argument);
    EXPECT_THROW(write_png(folder / "a.png", Image8()), std::invalid_argument);
    EXPECT_THROW(write_exr(folder / "a.exr", ImageF(2, 2, 3), {"X", "Y"}), std::invalid_argument);
}

TEST(ImageIo, ReadsHowAPhotographWasExposed) {
    const TemporaryFolder folder;
    const auto read = [&](const char* name, const std::string& bytes) {
        return read_image(folder.write(name, bytes)).settings;
    };
    const ExposureSettings said{1.0 / 125.0, 8.0, 200.0};
    const Image16 picture(8, 4, 3, 1000);
    const std::string jpeg = testing::jpeg_of(Image8(8, 4, 3, 90));
    const auto raw = testing::dng_of(
        64, 64, 0, [](int, int) { return std::uint16_t{900}; }, said);
    const ExposureSettings of_jpeg = read("a.jpg", testing::with_exif(jpeg, said)),
                           of_raw = read("a.dng", raw),
                           of_tiff = read("a.tif", testing::tiff_of(picture, said));
    for (const ExposureSettings& settings : {of_jpeg, of_raw, of_tiff}) {
        EXPECT_NEAR(settings.time_s, said.time_s, 1e-9);
        EXPECT_NEAR(settings.f_number, said.f_number, 1e-6);
    }
    EXPECT_EQ(of_jpeg.iso, said.iso);
    EXPECT_EQ(of_raw.iso, said.iso);
    EXPECT_EQ(of_tiff.iso, 0.0) << "a TIFF's is not read";
    // A lens without contacts, a file without any of it, and what no camera can have done
    const ExposureSettings some = read("b.jpg", testing::with_exif(jpeg, {2.0, 0.0, 100.0}));
    EXPECT_EQ(some, (ExposureSettings{2.0, 0.0, 100.0}));
    EXPECT_EQ(read("c.jpg", jpeg), ExposureSettings{});
    std::string zero = testing::with_exif(jpeg, {0.25, 4.0, 100.0});
    const std::string quarter = testing::little_endian(10, 4) + testing::little_endian(40, 4);
    zero.replace(zero.find(quarter), 8, testing::little_endian(10, 4) + std::string(4, '\0'));
    EXPECT_EQ(read("d.jpg", zero), (ExposureSettings{0.0, 4.0, 100.0}));
}

TEST(ExposureSettings, AreComparedByWhatBothSay) {
    const ExposureSettings usual{1.0 / 125.0, 8.0, 100.0};
    EXPECT_FALSE(are_exposed_otherwise(usual, {0.008001, 8.0, 100.0}));
    EXPECT_FALSE(are_exposed_otherwise(usual, {}));
    EXPECT_FALSE(are_exposed_otherwise(usual, {1.0 / 125.0, 0.0, 0.0}));
    EXPECT_TRUE(are_exposed_otherwise(usual, {1.0 / 128.0, 8.0, 100.0}));
    EXPECT_TRUE(are_exposed_otherwise(usual, {1.0 / 250.0, 8.0, 200.0})) << "as bright";
    EXPECT_DOUBLE_EQ(stops_over({1.0 / 250.0, 8.0, 200.0}, usual), 0.0);
    EXPECT_DOUBLE_EQ(stops_over({1.0 / 125.0, 4.0, 200.0}, usual), 3.0);
    EXPECT_DOUBLE_EQ(stops_over(usual, {1.0 / 125.0, 0.0, 400.0}), -2.0);
    EXPECT_EQ(text_of(usual), "1/125 s, f/8, ISO 100");
    EXPECT_EQ(text_of({0.5, 5.6, 0.0}), "0.5 s, f/5.6");
    EXPECT_EQ(text_of(ExposureSettings{}), "");
}

}  // namespace
}  // namespace livery
