#include "core/json.h"
#include "evaluation/ballot_place.h"

namespace livery {

std::string text_of(const BallotServerPlace& place) {
    const Json json = {{"address", place.address},
                       {"port", place.port},
                       {"tls", place.tls},
                       {"interface", place.interface},
                       {"hosts", place.hosts},
                       {"url", url_of(place)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

BallotServerPlace parse_ballot_place(const std::string& line) {
    const Json json = parse_json(line, "livery-ballots");
    const JsonReader reader("livery-ballots", json);
    BallotServerPlace place;
    place.address = reader["address"].text();
    place.port = static_cast<std::uint16_t>(reader["port"].integer(1, 65535));
    place.tls = reader["tls"].boolean();
    place.interface = reader["interface"].text();
    const JsonReader hosts = reader["hosts"];
    for (std::size_t k = 0; k < hosts.size(); ++k) place.hosts.push_back(hosts.at(k).text());
    return place;
}

std::string url_of(const BallotServerPlace& place) {
    const std::string host = place.hosts.empty() ? place.address : place.hosts.front();
    const bool usual = place.port == (place.tls ? 443 : 80);
    return (place.tls ? "https://" : "http://") + host +
           (usual ? std::string() : ":" + std::to_string(place.port)) + "/";
}

std::string join_url(const BallotServerPlace& place, const std::string& token) {
    return url_of(place) + "join/" + token;
}

std::string words_for(const BallotServerPlace& place) {
    std::string words = "The ballots are at " + url_of(place) + "\n";
    if (place.address.starts_with("127.")) {
        return words +
               "Only this machine reaches them; --interface NAME opens a network to them.\n";
    }
    words += "Whoever is on the network of " + place.interface + " reaches them.\n";
    if (!place.tls) {
        words +=
            "This is plain HTTP: whoever can listen to that network can see votes and take "
            "seats; --certificate and --key encrypt them.\n";
    }
    return words;
}

}  // namespace livery
