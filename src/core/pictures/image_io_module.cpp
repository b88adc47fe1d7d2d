#include "core/pictures/image_io_module.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "core/pictures/png_damage.h"

namespace {

using livery::ImageIoTable;
using livery::PictureError;
using livery::PictureHeader;

struct Picture {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  ///< outlives `input`
    std::unique_ptr<OIIO::ImageInput> input;
    PictureHeader header;
};

void say(PictureError* error, std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.empty()) text = "a picture that cannot be read";
    // Libraries pass on what C++ calls it.
    if (text.find("bad_alloc") != std::string::npos) text = "a picture too large for the memory";
    text.copy(error->text, sizeof error->text - 1);
    error->text[std::min(text.size(), sizeof error->text - 1)] = '\0';
}

/// Values as stored: no colour conversion, no premultiplied alpha. RAW: the camera's own linear
/// RGB without white balance, brightening or recovered highlights, as the sensor lies.
OIIO::ImageSpec reading_options(bool raw_half) {
    OIIO::ImageSpec options;
    options.attribute("oiio:UnassociatedAlpha", 1);
    options.attribute("raw:ColorSpace", "raw");
    options.attribute("raw:use_camera_wb", 0);
    options.attribute("raw:half_size", raw_half ? 1 : 0);
    options.attribute("raw:auto_bright", 0);
    // A camera that looks down is unsure which way is up, and may change its mind between shots.
    options.attribute("raw:user_flip", 0);
    const float no_balance[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    options.attribute("raw:user_mul", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 4), no_balance);
    return options;
}

/// A damaged file may say anything: what no camera can have done counts as not said.
double setting_of(const OIIO::ImageSpec& spec, const char* name, double least, double most) {
    const double value = static_cast<double>(spec.get_float_attribute(name, 0.0f));
    return value >= least && value <= most ? value : 0.0;
}

livery::ExposureSettings settings_of(const OIIO::ImageSpec& spec) {
    // Of JPEG and EXR by EXIF's newer name, of RAW by its older one; of TIFF it is not read.
    const double iso = setting_of(spec, "Exif:PhotographicSensitivity", 1.0, 1e8);
    return {setting_of(spec, "ExposureTime", 1e-7, 1e5),
            setting_of(spec, "FNumber", 0.1, 1e3),
            iso > 0.0 ? iso : setting_of(spec, "Exif:ISOSpeedRatings", 1.0, 1e8)};
}

bool has_even_width(const char* file) {
    const auto input = OIIO::ImageInput::create("raw");
    OIIO::ImageSpec spec;
    return input && input->open(file, spec, reading_options(false)) && spec.width % 2 == 0;
}

void* open_picture(const char* file,
                   const void* bytes,
                   std::size_t size,
                   const char* format,
                   PictureHeader* header,
                   PictureError* error) try {
    if (std::string_view(format) == "png") {
        std::unique_ptr<std::istream> stream;
        if (bytes) {
            stream = std::make_unique<std::istringstream>(
                std::string(static_cast<const char*>(bytes), size));
        } else {
            stream = std::make_unique<std::ifstream>(file, std::ios::binary);
        }
        if (const auto damage = livery::png_damage(*stream); !damage.empty()) {
            say(error, damage);
            return nullptr;
        }
    }
    const bool raw = std::string_view(format).starts_with("raw");
    // LibRaw's rows of half a picture are longer than it says where the whole has an odd width.
    const bool raw_half = std::string_view(format) == livery::kRawHalf && has_even_width(file);
    auto picture = std::make_unique<Picture>();
    picture->input = OIIO::ImageInput::create(raw ? "raw" : format);
    if (!picture->input) {
        say(error, OIIO::geterror());
        return nullptr;
    }
    if (bytes) {
        if (!picture->input->supports("ioproxy")) {
            say(error, std::string("a picture of the kind ") + format + " inside another file");
            return nullptr;
        }
        picture->memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, size);
        picture->input->set_ioproxy(picture->memory.get());
    }
    OIIO::ImageSpec spec;
    if (!picture->input->open(file, spec, reading_options(raw_half))) {
        say(error, picture->input->geterror());
        return nullptr;
    }
    const auto size_text = [](int width, int height, int x, int y) {
        return std::to_string(width) + "x" + std::to_string(height) + " at " + std::to_string(x) +
               "," + std::to_string(y);
    };
    if (spec.deep || spec.depth > 1) {
        say(error, "a deep or volume picture");
        return nullptr;
    }
    if (std::string_view(format) == "openexr" &&
        (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
         spec.height != spec.full_height)) {
        say(error,
            "a data window (" + size_text(spec.width, spec.height, spec.x, spec.y) +
                ") other than the display window (" +
                size_text(spec.full_width, spec.full_height, spec.full_x, spec.full_y) + ")");
        return nullptr;
    }
    int integer_bits = 0;
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            integer_bits = 8;
            break;
        case OIIO::TypeDesc::UINT16:
            integer_bits = 16;
            break;
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
            break;
        default:
            say(error, std::string("pixels of type ") + spec.format.c_str());
            return nullptr;
    }
    picture->header = {spec.width, spec.height, spec.nchannels, integer_bits, settings_of(spec)};
    *header = picture->header;
    return picture.release();
} catch (const std::exception& exception) {
    say(error, exception.what());
    return nullptr;
}

const char* channel_name(void* picture, int channel) {
    const auto& names = static_cast<Picture*>(picture)->input->spec().channelnames;
    const auto index = static_cast<std::size_t>(channel);
    return index < names.size() ? names[index].c_str() : "";
}

/// Through the stored type, because a detour over [0, 1] would not give whole numbers back.
template <typename T>
bool read_integers(Picture& picture, float* values) {
    const auto& header = picture.header;
    const auto in_row =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels);
    // A few rows at a time where the format has rows: the whole would be half as much again.
    const OIIO::ImageSpec spec = picture.input->spec();
    const int rows = spec.tile_width > 0 ? header.height : std::min(64, header.height);
    std::vector<T> stored(static_cast<std::size_t>(rows) * in_row);
    for (int y = 0; y < header.height; y += rows) {
        const int end = std::min(y + rows, header.height);
        const bool ok =
            spec.tile_width > 0
                ? picture.input->read_image(
                      0, 0, 0, header.channels, OIIO::BaseTypeFromC<T>::value, stored.data())
                : picture.input->read_scanlines(0,
                                                0,
                                                spec.y + y,
                                                spec.y + end,
                                                spec.z,
                                                0,
                                                header.channels,
                                                OIIO::BaseTypeFromC<T>::value,
                                                stored.data());
        if (!ok) return false;
        const auto count =
            static_cast<std::ptrdiff_t>(end - y) * static_cast<std::ptrdiff_t>(in_row);
        values = std::transform(stored.begin(), stored.begin() + count, values, [](T value) {
            return static_cast<float>(value);
        });
    }
    return true;
}

bool read_picture(void* handle, float* values, PictureError* error) try {
    auto& picture = *static_cast<Picture*>(handle);
    bool ok = false;
    switch (picture.header.integer_bits) {
        case 8:
            ok = read_integers<std::uint8_t>(picture, values);
            break;
        case 16:
            ok = read_integers<std::uint16_t>(picture, values);
            break;
        default:
            ok = picture.input->read_image(
                0, 0, 0, picture.header.channels, OIIO::TypeDesc::FLOAT, values);
    }
    // Some readers finish a cut file with grey and only leave a message.
    const std::string message = picture.input->geterror();
    if (ok && message.empty()) return true;
    say(error, message);
    return false;
} catch (const std::exception& exception) {
    say(error, exception.what());
    return false;
}

void close_picture(void* picture) { delete static_cast<Picture*>(picture); }

bool encode_picture(const char* format,
                    const PictureHeader& header,
                    const void* values,
                    const char* const* channel_names,
                    void (*sink)(void* context, const void* bytes, std::size_t size),
                    void* context,
                    PictureError* error) try {
    const auto type = header.integer_bits == 8    ? OIIO::TypeDesc::UINT8
                      : header.integer_bits == 16 ? OIIO::TypeDesc::UINT16
                                                  : OIIO::TypeDesc::FLOAT;
    auto output = OIIO::ImageOutput::create(format);
    if (!output) {
        say(error, OIIO::geterror());
        return false;
    }
    OIIO::ImageSpec spec(header.width, header.height, header.channels, type);
    if (channel_names) {
        for (int c = 0; c < header.channels; ++c) {
            spec.channelnames[static_cast<std::size_t>(c)] = channel_names[c];
        }
        spec.alpha_channel = -1;
    }
    // A picture is written while somebody waits. Deflate's quick levels lose a tenth of the size;
    // photographs' floats take PIZ a third of deflate's time at the same size.
    spec.attribute("png:compressionLevel", 2);
    spec.attribute("compression", "piz");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    output->set_ioproxy(&memory);
    const std::string name = std::string("memory.") + format;
    if (!output->open(name, spec) || !output->write_image(type, values) || !output->close()) {
        say(error, output->geterror());
        return false;
    }
    sink(context, bytes.data(), bytes.size());
    return true;
} catch (const std::exception& exception) {
    say(error, exception.what());
    return false;
}

constexpr ImageIoTable kTable = {
    open_picture, channel_name, read_picture, close_picture, encode_picture};

}  // namespace

extern "C" __attribute__((visibility("default"))) const ImageIoTable* livery_image_io_table() {
    return &kTable;
}
