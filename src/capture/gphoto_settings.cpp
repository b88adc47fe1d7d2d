#include "capture/gphoto_settings.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "capture/tethered_camera.h"

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

bool is_manual(const std::string& program) {
    return program.empty() || program == "M" || program.find("anual") != std::string::npos;
}

bool is_raw_format(const std::string& format) {
    std::string upper;
    for (const char c : format)
        upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return upper.find("RAW") != std::string::npos || upper.find("NEF") != std::string::npos ||
           upper.find("DNG") != std::string::npos;
}

double open_time_s(const CameraSetting& exposure, const std::string& said) {
    const double said_s = seconds_of_shutter_speed(said);
    const auto offers = [&](double wanted_s) {
        constexpr double kRounding = 0.015;
        return std::any_of(
            exposure.choices.begin(), exposure.choices.end(), [&](const std::string& choice) {
                return std::abs(seconds_of_shutter_speed(choice) / wanted_s - 1.0) < kRounding;
            });
    };
    const bool rounded = offers(1.0 / 30.0) && offers(1.0 / 60.0) && offers(1.0 / 125.0);
    if (!(said_s > 0.0) || !rounded) return said_s;
    const double steps = offers(1.0 / 45.0) || offers(1.0 / 90.0) ? 2.0 : 3.0;
    return std::exp2(std::round(steps * std::log2(said_s)) / steps);
}

std::string nearest_time(const CameraSetting& exposure, double seconds) {
    std::string best;
    double least = 1e300;
    for (const std::string& choice : exposure.choices) {
        const double time = open_time_s(exposure, choice);
        if (!(time > 0.0)) continue;
        const double distance = std::abs(std::log(time / seconds));
        if (distance < least) {
            least = distance;
            best = choice;
        }
    }
    return best;
}

}  // namespace livery
