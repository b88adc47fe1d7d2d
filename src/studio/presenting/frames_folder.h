// The frozen frames of a round on the disk: written once, and checked whenever they are loaded.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/image.h"

namespace livery {

using VoteFrames = std::map<std::string, std::shared_ptr<const Image8>>;

/// Of the picture's size and values.
std::string hash_of(const Image8& picture);

/// One PNG a frame, in a folder that appears whole or not at all. Throws FileError.
void write_vote_frames(const std::filesystem::path& folder, const VoteFrames& frames);

/// Those that `hashes` names. Throws FileError when one is missing or is not what was frozen.
VoteFrames read_vote_frames(const std::filesystem::path& folder,
                            const std::map<std::string, std::string>& hashes);

}  // namespace livery
