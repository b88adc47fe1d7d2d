// What a click and a vote cost beside the picture.
#include "benchmarks/car.h"
#include "evaluation/ballots.h"
#include "session/document.h"
#include "session/session.h"
#include "support/temporary_folder.h"

namespace livery::benchmarks {
namespace {

/// A command that is on disk when it returns, with a history of as many.
void SessionStep(benchmark::State& state) {
    const TemporaryFolder folder;
    Session session = Session::open(folder.path() / "session.livery");
    const int look = session.document().looks.front().id;
    bool red = false;
    for (auto _ : state) {
        red = !red;
        session.execute(SetPaint{look, "body", red ? "solid red" : "solid ivory"});
    }
}
BENCHMARK(SessionStep)->Unit(benchmark::kMillisecond)->UseRealTime();

void SessionUndo(benchmark::State& state) {
    const TemporaryFolder folder;
    Session session = Session::open(folder.path() / "session.livery");
    session.execute(SetPaint{session.document().looks.front().id, "body", "solid red"});
    for (auto _ : state) {
        session.undo();
        session.redo();
    }
}
BENCHMARK(SessionUndo)->Unit(benchmark::kMillisecond)->UseRealTime();

void ParseADocument(benchmark::State& state) {
    const std::string text = text_of(new_document("car"));
    for (auto _ : state) benchmark::DoNotOptimize(parse_document(text, "session"));
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(ParseADocument)->Unit(benchmark::kMicrosecond);

void TallyOfARound(benchmark::State& state) {
    const TemporaryFolder folder;
    BallotStore store(folder.path() / "ballots.livery");
    const int round = store.open_round({"red", "silver", "ivory", "blue"}, "");
    for (int k = 0; k < 100; ++k) {
        store.vote(round, "evaluator " + std::to_string(k), {k % 4, (k + 1) % 4});
    }
    store.close_round(round);
    for (auto _ : state) benchmark::DoNotOptimize(store.tally(round));
    count_items(state, 100);
}
BENCHMARK(TallyOfARound)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace livery::benchmarks
