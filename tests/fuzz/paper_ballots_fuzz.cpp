#include <algorithm>

#include "evaluation/paper_ballots.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    Round round;
    round.designs = {"red", "silver", "sand"};
    round.codes = {481, 376, 912};
    // The last byte chooses: what follows the end of a file says nothing.
    round.asks_least = !text.empty() && text.back() == '\n';
    const auto papers = parse_paper_ballots(text, "votes.csv", round);
    fuzz::require(!papers.empty() && papers.size() <= 1000, "some ballots and not too many");
    for (const PaperBallot& paper : papers) {
        const Ballot& choices = paper.ballot;
        fuzz::require(choices.best != choices.second, "two looks");
        fuzz::require(choices.least != choices.best && choices.least != choices.second, "another");
        fuzz::require(choices.least < 0 || round.asks_least, "a least where it was asked for");
        for (const int look : {choices.best, choices.second, std::max(choices.least, 0)}) {
            fuzz::require(look >= 0 && look < 3, "a look of the round");
        }
        fuzz::require(paper.paper >= 0 && paper.paper <= kMostPaper, "a paper's number");
    }
    fuzz::require(numbered(papers, 1).size() == papers.size(), "each has a number");
}
