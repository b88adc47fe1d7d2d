// One thread for what must not hold up the window: loading, saving, listing.
#pragma once

#include <exception>
#include <functional>
#include <memory>

#include "core/progress.h"

namespace livery {

class Background {
  public:
    /// What is to be done on the main thread with the result.
    using Then = std::function<void()>;
    /// Runs on the background thread; throws to fail.
    using Work = std::function<Then(const Progress& progress)>;

    /// `wake` is called on the background thread when something waits for take_results().
    explicit Background(std::function<void()> wake);
    ~Background();  ///< asks the running work to stop and waits for it
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    /// In order of asking. `failed` is called on the main thread with what `work` threw.
    void run(Work work, std::function<void(std::exception_ptr)> failed);
    /// Main thread: does what finished work asks for.
    void take_results();
    bool is_busy() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
