// The operator's side of a ballots file, for tests in other languages: one command, JSON on stdout.
//
//   ballot_operator FILE open NAMES [present] [least]   a round, names with commas; its number
//                                                       `waves=2`: in as many waves of seats;
//                                                       `scale=cheap,precious`: asked after it
//   ballot_operator FILE ratings ROUND                  of a locked round: {"seat": {"code": []}}
//   ballot_operator FILE voting|lock ROUND
//   ballot_operator FILE sitting ROUND NUMBER PHASE     a presented round's step (from 0; "voting")
//   ballot_operator FILE invitation                     {"token", "code"}, or null
//   ballot_operator FILE show                           checks the log; rounds, seats, who has
//   voted ballot_operator FILE ballots ROUND                  of a locked round: {"seat": [best,
//   second]} ballot_operator FILE session                        a new audience

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gnutls/x509.h>
#include <nlohmann/json.hpp>

#include "core/paths.h"
#include "evaluation/ballots.h"

namespace {

using namespace livery;
using Json = nlohmann::json;

Json shown(const BallotStore& store) {
    Json rounds = Json::array();
    for (const Round& round : store.rounds()) {
        rounds.push_back({{"id", round.id},
                          {"codes", round.codes},
                          {"voting", round.voting()},
                          {"closed", round.closed()},
                          {"voted", store.voted(round.id)}});
    }
    const auto session = store.session();
    return {{"rounds", rounds}, {"seats", session ? store.seats(*session).size() : 0}};
}

/// A certificate that signs itself, good for a day.
void make_certificate(const std::filesystem::path& folder) {
    const auto good = [](int code) {
        if (code < 0) throw std::runtime_error(gnutls_strerror(code));
    };
    gnutls_x509_privkey_t key = nullptr;
    gnutls_x509_crt_t certificate = nullptr;
    good(gnutls_x509_privkey_init(&key));
    good(gnutls_x509_privkey_generate(
        key, GNUTLS_PK_ECDSA, GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0));
    good(gnutls_x509_crt_init(&certificate));
    const std::time_t now = std::time(nullptr);
    const unsigned char serial[] = {1};
    in_addr address{};
    ::inet_pton(AF_INET, "127.0.0.1", &address);
    good(gnutls_x509_crt_set_version(certificate, 3));
    good(gnutls_x509_crt_set_serial(certificate, serial, sizeof serial));
    good(gnutls_x509_crt_set_activation_time(certificate, now - 3600));
    good(gnutls_x509_crt_set_expiration_time(certificate, now + 86400));
    good(gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, "test", 4));
    good(gnutls_x509_crt_set_subject_alt_name(
        certificate, GNUTLS_SAN_IPADDRESS, &address, sizeof address, GNUTLS_FSAN_SET));
    good(gnutls_x509_crt_set_basic_constraints(certificate, 1, 0));
    good(gnutls_x509_crt_set_key(certificate, key));
    good(gnutls_x509_crt_sign2(certificate, certificate, key, GNUTLS_DIG_SHA256, 0));
    gnutls_datum_t text{};
    good(gnutls_x509_crt_export2(certificate, GNUTLS_X509_FMT_PEM, &text));
    write_text_file(folder / "certificate.pem",
                    {reinterpret_cast<const char*>(text.data), text.size});
    gnutls_free(text.data);
    good(gnutls_x509_privkey_export2(key, GNUTLS_X509_FMT_PEM, &text));
    write_text_file(folder / "key.pem", {reinterpret_cast<const char*>(text.data), text.size});
    gnutls_free(text.data);
    gnutls_x509_crt_deinit(certificate);
    gnutls_x509_privkey_deinit(key);
}

Json done(BallotStore& store, const std::vector<std::string>& words) {
    const std::string& what = words.at(0);
    if (what == "open") {
        RoundSetup setup;
        std::istringstream names(words.at(1));
        for (std::string name; std::getline(names, name, ',');) setup.designs.push_back(name);
        for (std::size_t k = 2; k < words.size(); ++k) {
            setup.presenting = setup.presenting || words[k] == "present";
            setup.asks_least = setup.asks_least || words[k] == "least";
            if (words[k].starts_with("scale="))
                setup.scales.push_back(parse_scale(words[k].substr(6)));
            if (words[k].starts_with("waves=")) {
                std::vector<int> row(setup.designs.size());
                std::iota(row.begin(), row.end(), 0);
                PresentationPlan& plan = setup.plan.emplace();
                plan.sittings.assign(std::stoul(words[k].substr(6)), row);
                setup.presenting = true;
            }
        }
        return store.open_round(setup);
    }
    if (what == "voting") store.start_voting(std::stoi(words.at(1)));
    if (what == "lock") store.close_round(std::stoi(words.at(1)));
    if (what == "sitting") {
        PresentationState state;
        state.sitting = std::stoi(words.at(2));
        state.phase =
            words.at(3) == "voting" ? PresentationPhase::voting : PresentationPhase::presenting;
        store.record_step(std::stoi(words.at(1)), state, PresentationEvent::next);
    }
    if (what == "session") return store.open_session();
    if (what == "certificate") make_certificate(words.at(1));
    if (what == "show") return shown(store);
    if (what == "invitation") {
        const auto invitation = store.invitation(store.session().value());
        if (!invitation) return nullptr;
        return {{"token", invitation->token}, {"code", invitation->code}};
    }
    if (what == "ratings") {
        const int id = std::stoi(words.at(1));
        const Round round = store.round(id);
        Json ratings = Json::object();
        for (const auto& [seat, answers] : store.ratings(id)) {
            for (std::size_t k = 0; k < answers.size(); ++k) {
                const auto& steps = answers[k];
                if (std::count(steps.begin(), steps.end(), 0) == std::ssize(steps)) continue;
                Json& placed = ratings[std::to_string(seat)][std::to_string(round.codes[k])];
                for (const int step : steps)
                    placed.push_back(step > 0 ? Json(step) : Json(nullptr));
            }
        }
        return ratings;
    }
    if (what == "ballots") {
        Json ballots = Json::object();
        for (const CastBallot& cast : store.ballots(std::stoi(words.at(1)))) {
            ballots[std::to_string(cast.seat)] = {
                cast.ballot.best, cast.ballot.second, cast.receipt};
        }
        return ballots;
    }
    return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw std::invalid_argument("FILE and a command");
        BallotStore store(argv[1]);
        std::puts(done(store, {argv + 2, argv + argc}).dump().c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ballot_operator: %s\n", error.what());
        return 1;
    }
}
