#include "capture/gphoto/gphoto_settings.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

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

}  // namespace livery
