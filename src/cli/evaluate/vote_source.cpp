#include "cli/evaluate/vote_source.h"

#include <cstdlib>
#include <system_error>

#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr const char* kSample = "assets/sample-round/ballots.sqlite";

/// A copy of the sample, gone with the object: whoever opens a file of ballots must be able to
/// write beside it, and what is shipped may lie where nobody can.
class SampleCopy {
  public:
    SampleCopy() {
        std::string name = (std::filesystem::temp_directory_path() / "livery-XXXXXX").string();
        if (!::mkdtemp(name.data())) {
            throw FileError(name, "", "a folder that cannot be made", "a writable place");
        }
        folder_ = name;
        const auto shipped = shipped_path(kSample);
        file_ = folder_ / shipped.filename();
        std::error_code error;
        std::filesystem::copy_file(shipped, file_, error);
        if (error) throw FileError(file_, "", error.message(), "a writable place");
        std::filesystem::permissions(
            file_, std::filesystem::perms::owner_write, std::filesystem::perm_options::add, error);
    }
    ~SampleCopy() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    SampleCopy(const SampleCopy&) = delete;
    SampleCopy& operator=(const SampleCopy&) = delete;
    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path folder_, file_;
};

void check_one_source(const VoteSourceArguments& arguments) {
    const bool typed = !arguments.best.empty() || !arguments.second.empty() ||
                       !arguments.least.empty() || !arguments.names.empty();
    check_argument(!arguments.sample || (!typed && arguments.ballots.empty()),
                   "--sample: found it with counts, names or a file, expected it alone");
    check_argument(arguments.ballots.empty() || !typed,
                   "--ballots: found it with counts or names, expected either a file or counts");
    check_argument(!arguments.ballots.empty() || arguments.round == 0,
                   "--round: found it without --ballots, expected a file of ballots");
    if (!arguments.ballots.empty() || arguments.sample) return;
    check_argument(!arguments.best.empty(),
                   "--best: found no counts, expected them, or a file with --ballots");
    check_argument(!arguments.second.empty(), "--second: found no counts, expected them");
}

}  // namespace

std::vector<Option> vote_source_options(VoteSourceArguments& arguments) {
    return {
        {"--best", "N,N,...", "how often each design was named best", &arguments.best},
        {"--second", "N,N,...", "how often second best", &arguments.second},
        {"--least", "N,N,...", "how often least, where every ballot named one", &arguments.least},
        {"--names",
         "A,B,...",
         "what the designs are called (default (a), (b), ...)",
         &arguments.names},
        {"--ballots", "FILE", "a file of ballots, instead", &arguments.ballots},
        {"--round", "N", "which of its rounds (default: the last closed)", &arguments.round},
        {"--sample", "", "the made-up round that comes with Livery, instead", &arguments.sample},
    };
}

VoteSource read_vote_source(const VoteSourceArguments& arguments, std::uint64_t seed) {
    check_one_source(arguments);
    if (arguments.sample) {
        const SampleCopy copy;
        VoteSource source{report_source(read_closed_round(copy.file(), {}, seed), seed), {}};
        source.details = round_details_file(shipped_path(kSample), source.round.record->round.id);
        return source;
    }
    if (!arguments.ballots.empty()) {
        VoteSource source{
            report_source(read_closed_round(arguments.ballots, round_option(arguments.round), seed),
                          seed),
            {}};
        source.details = round_details_file(arguments.ballots, source.round.record->round.id);
        return source;
    }
    VoteCounts counts{parse_counts("--best", arguments.best),
                      parse_counts("--second", arguments.second)};
    if (!arguments.least.empty()) counts.least = parse_counts("--least", arguments.least);
    check_typed_counts(counts);
    VoteSource source;
    source.round.names = names_or_letters(arguments.names, counts.designs());
    source.round.statistics = vote_statistics(counts, source.round.names, seed);
    return source;
}

}  // namespace livery
