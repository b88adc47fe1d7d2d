#include "capture/gphoto/gphoto_camera.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace livery {

Widget find_widget(GphotoCamera& gphoto, const Names& names, std::string* found) {
    for (const char* name : names) {
        CameraWidget* widget = nullptr;
        if (gp_camera_get_single_config(gphoto.camera(), name, &widget, gphoto.context()) < 0) {
            gphoto.forget();
            continue;
        }
        Widget owned(widget);
        CameraWidgetType type{};
        gp_widget_get_type(widget, &type);
        const bool readable = type == GP_WIDGET_RADIO || type == GP_WIDGET_MENU ||
                              type == GP_WIDGET_TEXT || type == GP_WIDGET_RANGE;
        if (!readable) continue;  // a switch that has its name
        if (found) *found = name;
        return owned;
    }
    return nullptr;
}

std::string value_of(CameraWidget* widget) {
    CameraWidgetType type{};
    gp_widget_get_type(widget, &type);
    if (type == GP_WIDGET_RANGE) {
        float value = 0.0f;
        gp_widget_get_value(widget, &value);
        return fmt::format("{:g}", value);
    }
    const char* text = nullptr;
    gp_widget_get_value(widget, &text);
    return text ? text : "";
}

CameraSetting setting_of(const char* name, CameraWidget* widget) {
    CameraSetting setting;
    setting.name = name;
    setting.value = value_of(widget);
    int read_only = 0;
    gp_widget_get_readonly(widget, &read_only);
    setting.can_be_set = read_only == 0;
    for (int k = 0; k < gp_widget_count_choices(widget); ++k) {
        const char* choice = nullptr;
        if (gp_widget_get_choice(widget, k, &choice) >= 0 && choice)
            setting.choices.emplace_back(choice);
    }
    return setting;
}

CameraSetting set_widget(GphotoCamera& gphoto,
                         const char* name,
                         const Names& names,
                         const std::string& value) {
    std::string widget_name;
    const Widget widget = find_widget(gphoto, names, &widget_name);
    if (!widget)
        throw GphotoError{GP_ERROR_NOT_SUPPORTED, fmt::format("it has no setting {}", name)};
    const CameraSetting now = setting_of(name, widget.get());
    if (!now.choices.empty() &&
        std::find(now.choices.begin(), now.choices.end(), value) == now.choices.end())
        throw GphotoError{GP_ERROR_BAD_PARAMETERS,
                          fmt::format("{} {} is none of its choices", name, value)};
    CameraWidgetType type{};
    gp_widget_get_type(widget.get(), &type);
    const auto number = static_cast<float>(std::atof(value.c_str()));
    gphoto.check(type == GP_WIDGET_RANGE ? gp_widget_set_value(widget.get(), &number)
                                         : gp_widget_set_value(widget.get(), value.c_str()));
    gphoto.check(gp_camera_set_single_config(
        gphoto.camera(), widget_name.c_str(), widget.get(), gphoto.context()));
    const Widget again = find_widget(gphoto, names);
    return again ? setting_of(name, again.get()) : CameraSetting{};
}

std::optional<int> shots_left(GphotoCamera& gphoto) {
    ::CameraStorageInformation* stores = nullptr;
    int count = 0;
    if (gp_camera_get_storageinfo(gphoto.camera(), &stores, &count, gphoto.context()) < 0) {
        gphoto.forget();
        return std::nullopt;
    }
    std::optional<int> left;
    for (int k = 0; k < count; ++k)
        if (stores[k].fields & GP_STORAGEINFO_FREESPACEIMAGES)
            left = left.value_or(0) + static_cast<int>(stores[k].freeimages);
    std::free(stores);
    return left;
}

namespace {

constexpr int kMostToConnect_ms = 3000;

template <typename T, int (*Free)(T*)>
struct Freed {
    void operator()(T* it) const { Free(it); }
};
using PortList = std::unique_ptr<GPPortInfoList, Freed<GPPortInfoList, gp_port_info_list_free>>;
using AbilitiesList =
    std::unique_ptr<CameraAbilitiesList, Freed<CameraAbilitiesList, gp_abilities_list_free>>;
using NameList = std::unique_ptr<CameraList, Freed<CameraList, gp_list_free>>;

template <typename List, typename T>
List make(int (*create)(T**)) {
    T* it = nullptr;
    create(&it);
    return List(it);
}

/// libgphoto2 takes the port of a network camera twice: for commands and for events.
std::string port_of_gphoto(const std::string& port) {
    constexpr std::string_view kNetwork = "ptpip:";
    if (!port.starts_with(kNetwork)) return port;
    const std::size_t colon = port.find(':', kNetwork.size());
    return colon == std::string::npos ? port : port + port.substr(colon);
}

/// Whether somebody answers there: libgphoto2 takes minutes to find out.
bool is_reachable(const std::string& port) {
    const std::string address = port.substr(port.find(':') + 1);
    const std::size_t colon = address.find(':');
    const std::string host = address.substr(0, colon);
    const std::string service = colon == std::string::npos ? "15740" : address.substr(colon + 1);
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(host.c_str(), service.c_str(), &wanted, &found) != 0) return false;
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> freed(found, ::freeaddrinfo);
    for (const addrinfo* one = found; one; one = one->ai_next) {
        const int tried =
            ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (tried < 0) continue;
        bool connected = ::connect(tried, one->ai_addr, one->ai_addrlen) == 0;
        if (!connected && errno == EINPROGRESS) {
            pollfd waiting{tried, POLLOUT, 0};
            int error = 0;
            socklen_t size = sizeof(error);
            connected = ::poll(&waiting, 1, kMostToConnect_ms) == 1 &&
                        ::getsockopt(tried, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
        }
        ::close(tried);
        if (connected) return true;
    }
    return false;
}

}  // namespace

GphotoCamera::GphotoCamera(const std::string& port) : context_(gp_context_new()) {
    gp_context_set_error_func(
        context_,
        [](GPContext*, const char* text, void* self) {
            static_cast<GphotoCamera*>(self)->said_ = text;
        },
        this);
    try {
        open(port);
    } catch (const GphotoError&) {
        if (camera_) gp_camera_unref(camera_);
        gp_context_unref(context_);
        throw;
    }
}

GphotoCamera::~GphotoCamera() {
    if (is_open_) gp_camera_exit(camera_, context_);
    if (camera_) gp_camera_unref(camera_);
    gp_context_unref(context_);
}

void GphotoCamera::check(int result) {
    if (result >= 0) return;
    std::string what = said_.empty() ? gp_result_as_string(result) : std::exchange(said_, "");
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw GphotoError{result, what};
}

void GphotoCamera::open(const std::string& port) {
    const auto ports = make<PortList>(gp_port_info_list_new);
    check(gp_port_info_list_load(ports.get()));
    const auto abilities = make<AbilitiesList>(gp_abilities_list_new);
    check(gp_abilities_list_load(abilities.get(), context_));
    std::string path = port_of_gphoto(port);
    model_ = "PTP/IP Camera";
    if (path.starts_with("ptpip:") && !is_reachable(port))
        throw GphotoError{GP_ERROR_IO, "nobody answers at " + port};
    if (!path.starts_with("ptpip:")) {
        const auto found = gphoto_cameras_on_usb();
        const auto wanted = std::find_if(found.begin(), found.end(), [&](const auto& one) {
            return path.empty() || one.second == path;
        });
        if (wanted == found.end())
            throw GphotoError{
                GP_ERROR_IO_USB_FIND,
                path.empty() ? "no camera is found on USB" : "no camera is found at " + path};
        model_ = wanted->first;
        path = wanted->second;
    }
    check(gp_camera_new(&camera_));
    const int place = gp_port_info_list_lookup_path(ports.get(), path.c_str());
    check(place);
    GPPortInfo info;
    check(gp_port_info_list_get_info(ports.get(), place, &info));
    check(gp_camera_set_port_info(camera_, info));
    const int model = gp_abilities_list_lookup_model(abilities.get(), model_.c_str());
    check(model);
    CameraAbilities what;
    check(gp_abilities_list_get_abilities(abilities.get(), model, &what));
    check(gp_camera_set_abilities(camera_, what));
    const auto before = std::chrono::steady_clock::now();
    const int opened = gp_camera_init(camera_, context_);
    const auto waited = std::chrono::steady_clock::now() - before;
    // A camera that cannot be opened refuses nothing in particular: it is not there.
    if (opened == GP_ERROR)
        throw GphotoError{GP_ERROR_IO, said_.empty() ? "it cannot be opened" : said_};
    // One on a network that takes a connection and then says nothing for seconds is asleep; one
    // that hangs up at once is not.
    if (opened == GP_ERROR_IO && waited > std::chrono::seconds(1))
        throw GphotoError{GP_ERROR_TIMEOUT, "it takes a connection and says nothing"};
    check(opened);
    is_open_ = true;
}

std::vector<std::pair<std::string, std::string>> gphoto_cameras_on_usb() {
    GPContext* context = gp_context_new();
    const auto names = make<NameList>(gp_list_new);
    gp_camera_autodetect(names.get(), context);
    gp_context_unref(context);
    std::vector<std::pair<std::string, std::string>> found;
    for (int k = 0; k < gp_list_count(names.get()); ++k) {
        const char *model = nullptr, *port = nullptr;
        gp_list_get_name(names.get(), k, &model);
        gp_list_get_value(names.get(), k, &port);
        if (model && port && std::string_view(port).starts_with("usb:"))
            found.emplace_back(model, port);
    }
    return found;
}

}  // namespace livery
