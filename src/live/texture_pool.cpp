#include "live/texture_pool.h"

#include <deque>
#include <mutex>
#include <vector>

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

}  // namespace livery
