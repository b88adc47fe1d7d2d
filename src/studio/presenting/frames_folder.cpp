#include "studio/presenting/frames_folder.h"

#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/replace_folder.h"

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

}  // namespace livery
