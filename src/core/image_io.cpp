#include "core/image_io.h"

#include <OpenImageIO/imageio.h>

#include "core/error.h"

namespace livery {

namespace {

template <typename T>
void write_image(const std::filesystem::path& file,
                 const Image<T>& image,
                 OIIO::TypeDesc type,
                 const std::vector<std::string>& channel_names) {
    auto output = OIIO::ImageOutput::create(file.string());
    if (!output) throw FileError(file, "", OIIO::geterror(), "a known picture format");
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
    if (!channel_names.empty()) spec.channelnames = channel_names;
    const auto base = OIIO::TypeDesc(OIIO::BaseTypeFromC<T>::value);
    if (!output->open(file.string(), spec) || !output->write_image(base, image.values.data()) ||
        !output->close()) {
        throw FileError(file, "", output->geterror(), "a writable place");
    }
}

}  // namespace

ImageFile read_image(const std::filesystem::path& file, std::size_t max_pixels) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        throw FileError(file, "", "no such file", "a picture");
    }
    auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw FileError(file, "", OIIO::geterror(), "a readable picture");
    const OIIO::ImageSpec& spec = input->spec();
    const auto pixels = static_cast<std::size_t>(spec.image_pixels());
    if (pixels > max_pixels) {
        throw FileError(file,
                        "size",
                        std::to_string(spec.width) + "x" + std::to_string(spec.height),
                        "at most " + std::to_string(max_pixels) + " pixels");
    }
    ImageFile result;
    result.image = ImageF(spec.width, spec.height, spec.nchannels);
    result.channel_names = spec.channelnames;
    result.floating_point = spec.format.is_floating_point();
    if (!result.floating_point) result.full_scale = spec.format.size() == 1 ? 255.0 : 65535.0;
    if (!input->read_image(
            0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, result.image.values.data())) {
        throw FileError(file, "", input->geterror(), "a complete picture");
    }
    if (!result.floating_point) {
        const auto scale = static_cast<float>(result.full_scale);
        for (float& value : result.image.values) value *= scale;
    }
    return result;
}

void write_exr(const std::filesystem::path& file,
               const ImageF& image,
               const std::vector<std::string>& channel_names) {
    write_image(file, image, OIIO::TypeDesc::FLOAT, channel_names);
}

void write_png(const std::filesystem::path& file, const Image8& image) {
    write_image(file, image, OIIO::TypeDesc::UINT8, {});
}

void write_png(const std::filesystem::path& file, const Image16& image) {
    write_image(file, image, OIIO::TypeDesc::UINT16, {});
}

}  // namespace livery
