// livery-ballots: the phone page's server, a process of its own.

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <getopt.h>

#include "ballot/ballot_guard.h"
#include "ballot/ballot_service.h"
#include "ballot/http_server.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "evaluation/phone_page.h"

namespace livery {
namespace {

// A handler may touch nothing else.
std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr const char* kHelp =
    "livery-ballots: serves the page on which people vote with their phones.\n"
    "livery evaluate serve starts it; the window does too.\n"
    "\n"
    "  livery-ballots --ballots FILE [--interface NAME] [--port N]\n"
    "\n"
    "  --ballots FILE      where votes are kept, made when it is not there; no other file is "
    "opened\n"
    "  --interface NAME    the network to listen on (default lo: this machine alone)\n"
    "  --port N            default 8470; 0: any that is free\n"
    "  --host NAME         a further name of this machine, as \"livery.local\"; may be repeated\n"
    "  --certificate FILE  with --key: PEM files, for HTTPS\n"
    "  --seats N           phones, 1 to 400 (default 40), apart from the first at an address\n"
    "  --with-parent       end with the program that started this one\n"
    "  --json              say where it listens as one line of JSON\n"
    "\n"
    "  livery-ballots --ballots ballots.sqlite --interface wlan0\n";

struct ServeOptions {
    std::string ballots, interface = "lo", certificate, key;
    std::vector<std::string> hosts;
    int port = kBallotPort, seats = 40;
    bool with_parent = false, json = false, help = false;
};

int whole_number(const char* option, const std::string& text, int low, int high) {
    std::size_t used = 0;
    long number = -1;
    try {
        number = std::stol(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != text.size() || number < low || number > high) {
        throw std::invalid_argument(std::string(option) + ": found \"" + printable(text, 40) +
                                    "\", expected a whole number from " + std::to_string(low) +
                                    " to " + std::to_string(high));
    }
    return static_cast<int>(number);
}

void check_host(const std::string& host) {
    constexpr const char* allowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-";
    if (!host.empty() && host.size() < 254 &&
        host.find_first_not_of(allowed) == std::string::npos) {
        return;
    }
    throw std::invalid_argument("--host: found \"" + printable(host, 80) +
                                "\", expected a name of this machine, without port");
}

ServeOptions parse_options(int argc, char** argv) {
    const option known[] = {{"ballots", required_argument, nullptr, 'b'},
                            {"interface", required_argument, nullptr, 'i'},
                            {"port", required_argument, nullptr, 'p'},
                            {"host", required_argument, nullptr, 'n'},
                            {"certificate", required_argument, nullptr, 'c'},
                            {"key", required_argument, nullptr, 'k'},
                            {"seats", required_argument, nullptr, 's'},
                            {"with-parent", no_argument, nullptr, 'w'},
                            {"json", no_argument, nullptr, 'j'},
                            {"help", no_argument, nullptr, 'h'},
                            {nullptr, 0, nullptr, 0}};
    ServeOptions options;
    ::opterr = 0;
    for (int found = 0; (found = ::getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        const std::string value = ::optarg ? ::optarg : "";
        if (found == 'b') options.ballots = value;
        if (found == 'i') options.interface = value;
        if (found == 'p') options.port = whole_number("--port", value, 0, 65535);
        if (found == 'n') options.hosts.push_back(value);
        if (found == 'c') options.certificate = value;
        if (found == 'k') options.key = value;
        if (found == 's') options.seats = whole_number("--seats", value, 1, 400);
        if (found == 'w') options.with_parent = true;
        if (found == 'j') options.json = true;
        if (found == 'h') options.help = true;
        if (found == '?') {
            throw std::invalid_argument("found \"" + printable(argv[::optind - 1], 80) +
                                        "\", expected an option of livery-ballots --help");
        }
    }
    if (::optind < argc) {
        throw std::invalid_argument("found \"" + printable(argv[::optind], 80) +
                                    "\", expected options alone");
    }
    if (options.help) return options;
    if (options.ballots.empty()) {
        throw std::invalid_argument("--ballots: found nothing, expected a file for the votes");
    }
    if (options.certificate.empty() != options.key.empty()) {
        throw std::invalid_argument(
            "--certificate: found one of --certificate and --key, expected both or none");
    }
    for (const std::string& host : options.hosts) check_host(host);
    return options;
}

/// The first IPv4 address of the interface ("lo", "wlan0"). Throws std::invalid_argument that lists
/// the interfaces that have one.
std::string interface_address(const std::string& name) {
    std::vector<std::string> names;
    for (const NetworkInterface& network : network_interfaces()) {
        if (name == network.name) return network.address;
        names.push_back(network.name + " (" + network.address + ")");
    }
    throw std::invalid_argument("--interface: found \"" + name +
                                "\", expected one with an IPv4 address: " + list_of(names));
}

/// The names under which browsers know this server, once its port is known.
ServerNames names_of(const ServeOptions& options, const std::string& address, std::uint16_t port) {
    ServerNames names;
    names.tls = !options.certificate.empty();
    std::vector<std::string> hosts = options.hosts;
    hosts.push_back(address);
    if (address.starts_with("127.")) hosts.emplace_back("localhost");
    for (std::string& host : hosts) {
        for (char& c : host) {
            if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        }
        names.hosts.push_back(host + ":" + std::to_string(port));
        // Browsers leave out the port that goes without saying.
        if (port == (names.tls ? 443 : 80)) names.hosts.push_back(host);
    }
    return names;
}

double seconds_since_1970() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

int serve(const ServeOptions& options) {
    HttpSettings settings;
    settings.address = interface_address(options.interface);
    settings.port = static_cast<std::uint16_t>(options.port);
    if (!options.certificate.empty()) {
        settings.certificate = read_text_file(options.certificate, 1u << 20u);
        settings.key = read_text_file(options.key, 1u << 20u);
    }
    limit_this_process();
    if (options.with_parent) end_with_parent();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        std::signal(signal, [](int) { stop_asked = true; });
    }
    // Its names hold the port, which is known once it listens; nobody is answered before run().
    std::unique_ptr<BallotService> service;
    HttpServer server(settings, [&](const BallotRequest& request) {
        return service->answer(request, seconds_since_1970());
    });
    const ServerNames names = names_of(options, settings.address, server.port());
    service = std::make_unique<BallotService>(options.ballots,
                                              BallotServiceSettings{names, options.seats});
    service->keep_invitation(seconds_since_1970());
    const BallotServerPlace place{
        settings.address, server.port(), names.tls, options.interface, options.hosts};
    std::fputs((options.json ? text_of(place) + "\n" : words_for(place)).c_str(), stdout);
    if (std::fflush(stdout) != 0) throw std::runtime_error("stdout: cannot write");
    bool told = false;
    server.run(stop_asked, [&] {
        try {
            service->keep_invitation(seconds_since_1970());
        } catch (const FileError& error) {
            // A full disk ends no vote: who is in stays in. The code that has run out stays so.
            if (!std::exchange(told, true))
                std::fprintf(stderr, "livery-ballots: %s\n", error.what());
        }
    });
    return 0;
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    try {
        const auto options = livery::parse_options(argc, argv);
        if (options.help) return std::fputs(livery::kHelp, stdout) < 0 ? 2 : 0;
        return livery::serve(options);
    } catch (const std::exception& error) {
        const std::string line = "livery-ballots: " + livery::printable(error.what(), 4000) + "\n";
        std::fputs(line.c_str(), stderr);
        return 2;
    }
}
