// Big values that are made over and over: given back instead of freed, from any thread.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace livery {

/// take() gives one that nobody else holds, with whatever its last holder left in it. Values may
/// outlive the recycler.
template <typename T>
class Recycler {
  public:
    explicit Recycler(std::size_t kept = 4) : shelf_(std::make_shared<Shelf>()) {
        shelf_->kept = kept;
    }
    ~Recycler() {
        const std::scoped_lock lock(shelf_->mutex);
        shelf_->kept = 0;
        shelf_->values.clear();
    }
    Recycler(const Recycler&) = delete;
    Recycler& operator=(const Recycler&) = delete;

    std::shared_ptr<T> take() {
        std::unique_ptr<T> value;
        {
            const std::scoped_lock lock(shelf_->mutex);
            if (!shelf_->values.empty()) {
                value = std::move(shelf_->values.back());
                shelf_->values.pop_back();
            }
        }
        if (!value) value = std::make_unique<T>();
        return {value.release(), [shelf = shelf_](T* returned) {
                    std::unique_ptr<T> owned(returned);
                    const std::scoped_lock lock(shelf->mutex);
                    if (shelf->values.size() < shelf->kept) {
                        shelf->values.push_back(std::move(owned));
                    }
                }};
    }

  private:
    struct Shelf {
        std::mutex mutex;
        std::size_t kept = 0;
        std::vector<std::unique_ptr<T>> values;
    };
    std::shared_ptr<Shelf> shelf_;
};

}  // namespace livery
