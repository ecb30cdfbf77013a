#include <map>

#include "sensors/sensor_file.h"

namespace pyroscene::sensors {

void read_distribution(const config::Node& distribution, Sensor& sensor) {
    if (!distribution.present()) return;
    const std::map<std::string, NativeForm> forms{{"aviris_envi", NativeForm::AvirisEnvi},
                                                  {"aviris_ng_envi", NativeForm::AvirisNgEnvi},
                                                  {"modis_l1b", NativeForm::ModisL1b},
                                                  {"viirs_l1b", NativeForm::ViirsL1b},
                                                  {"frames", NativeForm::OrientedFrames},
                                                  {"strip", NativeForm::AirborneStrip},
                                                  {"", NativeForm::None}};
    std::vector<std::string> words;
    for (const auto& [word, form] : forms)
        if (!word.empty()) words.push_back(word);
    sensor.native_form = forms.at(distribution.choice("native_form", "", words));
    const auto gains = distribution.child("gains");
    if (gains.present()) {
        const auto first = gains.numbers("first_channels", 0), gain = gains.numbers("counts_per_native_unit", 0);
        if (first.empty() || first.size() != gain.size() || first.front() != 1.0)
            gains.report("expected 'first_channels' (from 1 on) and as many 'counts_per_native_unit'");
        else
            for (std::size_t band = 0, step = 0; band < sensor.bands.size(); ++band) {
                while (step + 1 < first.size() && static_cast<double>(band + 1) >= first[step + 1]) ++step;
                sensor.native_gain.push_back(gain[step]);
            }
        gains.finish();
    }
    if (sensor.native_form == NativeForm::AvirisEnvi && !gains.present())
        distribution.report("native_form 'aviris_envi' needs 'gains'");
    for (const char* key : {"swath", "map", "fire", "granule_s", "lines_per_granule_1km"}) distribution.ignore(key);
    distribution.finish();
}

}  // namespace pyroscene::sensors
