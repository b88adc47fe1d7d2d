// The quick ledger measured beside a window, when somebody asks what accuracy costs on this
// machine.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ledger/accuracy/accuracy.h"

namespace livery {

class AccuracyThread {
  public:
    /// `on_change` is called on the thread after every row and at the end, and must not throw.
    explicit AccuracyThread(std::function<void()> on_change);
    ~AccuracyThread();
    AccuracyThread(const AccuracyThread&) = delete;
    AccuracyThread& operator=(const AccuracyThread&) = delete;

    /// One look in one light; nothing happens while that runs. What is whole is written to
    /// accuracy_file().
    void measure();
    void stop();  ///< returns at once

    struct State {
        bool running = false;
        double fraction = 0.0;
        std::string doing;                             ///< "shadows sharp: car, solid red, studio"
        std::shared_ptr<const AccuracyLedger> ledger;  ///< as far as it goes; null: no row yet
        bool whole = false;                            ///< of the ledger
        std::string problem;                           ///< why the last one is not
    };
    State state() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
