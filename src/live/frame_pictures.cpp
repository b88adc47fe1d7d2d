#include "live/frame_pictures.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <vector>

#include "core/error.h"
#include "gl/read_back.h"

namespace livery {

namespace {

/// A texture rests until so many others have come back after it: whoever gave it back may have
/// asked its own context to read it once more.
constexpr std::size_t kResting = 2;

}  // namespace

struct TexturePool::Shared {
    std::mutex mutex;
    std::vector<std::unique_ptr<Slot>> all;  ///< the memory outlives the pool, the textures do not
    std::deque<Slot*> returned;              ///< the longest returned first
};

TexturePool::TexturePool(TexelFormat format)
    : format_(format), shared_(std::make_shared<Shared>()) {}

TexturePool::~TexturePool() {
    const std::scoped_lock lock(shared_->mutex);
    for (const auto& slot : shared_->all) *slot = Slot{};
}

std::shared_ptr<TexturePool::Slot> TexturePool::lend(int width, int height) {
    Slot* slot = nullptr;
    {
        const std::scoped_lock lock(shared_->mutex);
        if (shared_->returned.size() > kResting) {
            slot = shared_->returned.front();
            shared_->returned.pop_front();
        } else {
            slot = shared_->all.emplace_back(std::make_unique<Slot>()).get();
        }
    }
    const auto give_back = [shared = shared_](Slot* returned) {
        const std::scoped_lock lock(shared->mutex);
        shared->returned.push_back(returned);
    };
    std::shared_ptr<Slot> lent(slot, give_back);
    if (!slot->texture || slot->texture.width() != width || slot->texture.height() != height) {
        slot->framebuffer = Framebuffer();
        slot->texture = Texture2D({width, height}, format_, TexelFilter::linear);
        ++made_;
        slot->framebuffer = Framebuffer({&slot->texture});
    }
    return lent;
}

namespace {

const Texture2D& finished_texture(const TexturePool::Slot& slot) {
    check_argument(static_cast<bool>(slot.texture), "a picture of a frame thread that has ended");
    slot.ready.wait_on_device();
    return slot.texture;
}

std::shared_ptr<const ImageF> fetched(const FramePicture<ImageF>& picture) {
    if (picture.image || !picture.slot) return picture.image;
    return std::make_shared<const ImageF>(read_floats(finished_texture(*picture.slot)));
}

template <typename T>
void copy_columns(const Image<T>& from, int begin, int end, Image<T>* to) {
    if (begin >= end) return;
    for (int y = 0; y < from.height; ++y) {
        const T* row = from.pixel(0, y);
        std::copy(row + begin * from.channels, row + end * from.channels, to->pixel(begin, y));
    }
}

}  // namespace

template <typename T>
void join_columns(const Image<T>& left, const Image<T>& right, int column, Image<T>* joined) {
    if (joined->width != left.width || joined->height != left.height ||
        joined->channels != left.channels) {
        *joined = Image<T>(left.width, left.height, left.channels);
    }
    copy_columns(left, 0, column, joined);
    copy_columns(right, column, right.width, joined);
}

template void join_columns(const Image8&, const Image8&, int, Image8*);
template void join_columns(const ImageF&, const ImageF&, int, ImageF*);

std::shared_ptr<const Image8> drive_of(const FramePictures& pictures) {
    const FramePicture<Image8>& drive = pictures.drive;
    if (drive.image || !drive.slot) return drive.image;
    return std::make_shared<const Image8>(read_bytes(finished_texture(*drive.slot), 3));
}

std::shared_ptr<const ImageF> radiance_of(const FramePictures& pictures) {
    const auto left = fetched(pictures.radiance[0]);
    const auto right = fetched(pictures.radiance[1]);
    if (!left || !right) return left;
    auto joined = std::make_shared<ImageF>();
    join_columns(*left, *right, pictures.column, joined.get());
    return joined;
}

}  // namespace livery
