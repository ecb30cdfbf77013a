#include "radiometry/planck.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "radiometry/response.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Gauss-Legendre rule of 10 points on [-1, 1] (symmetric half).
constexpr double kNodes[5] = {0.14887433898163121088, 0.43339539412924719080, 0.67940956829902440623, 0.86506336668898451073,
                              0.97390652851717172008};
constexpr double kWeights[5] = {0.29552422471475287017, 0.26926671930999635509, 0.21908636251598204400,
                                0.14945134915058059315, 0.06667134430868813759};

/// Beyond this distance from its lower limit the integrand x^3 / (e^x - 1) adds less than 1e-20 of the integral.
constexpr double kTail = 60.0;

/// x^3 / (e^x - 1): the Planck function in x = c2 / (lambda T); B dlambda = c1L T^4 / c2^4 times this dx.
double planck_x(double x) noexcept { return x > 0.0 ? x * x * x / std::expm1(x) : 0.0; }

/// Integral of f over [a, b] in panels short against the distance 2 pi to the poles of the integrand.
template <class Function>
double integrate(double a, double b, const Function& f) {
    constexpr double kPanel = 1.5;
    const int panels = std::max(1, static_cast<int>(std::ceil((b - a) / kPanel)));
    const double half = 0.5 * (b - a) / panels;
    double sum = 0.0;
    for (int p = 0; p < panels; ++p) {
        const double centre = a + (2 * p + 1) * half;
        for (int k = 0; k < 5; ++k) sum += kWeights[k] * (f(centre - half * kNodes[k]) + f(centre + half * kNodes[k]));
    }
    return sum * half;
}

double scale_W_m2_sr(double T_K) noexcept {
    const double t = T_K / kC2_um_K;
    return kC1L_W_um4_m2_sr * t * t * t * t;
}

/// int R B dlambda and its derivative in temperature, over the polyline.
struct BandIntegral {
    double radiance = 0.0, per_K = 0.0;
};

BandIntegral integrate_band(double T_K, const Spectrum& response) {
    const auto& lambda = response.lambda_um;
    double coldest_x = kC2_um_K / (lambda.back() * T_K);  // where the integrand is largest in the Wien region
    BandIntegral sum;
    for (std::size_t i = lambda.size() - 1; i > 0; --i) {
        const double l0 = lambda[i - 1], l1 = lambda[i], r0 = response.value[i - 1], r1 = response.value[i];
        if (l1 <= l0 || (r0 == 0.0 && r1 == 0.0)) continue;
        const double slope = (r1 - r0) / (l1 - l0), a = kC2_um_K / (l1 * T_K);
        if (sum.radiance == 0.0) coldest_x = a;
        const double b = std::min(kC2_um_K / (l0 * T_K), coldest_x + kTail + 4.0 * std::log1p(coldest_x));
        if (b <= a) break;
        const auto response_at = [&](double x) { return r0 + slope * (kC2_um_K / (x * T_K) - l0); };
        sum.radiance += integrate(a, b, [&](double x) { return response_at(x) * planck_x(x); });
        // dB/dT = B / T * x / (1 - e^-x)
        sum.per_K += integrate(a, b, [&](double x) { return response_at(x) * planck_x(x) * x / -std::expm1(-x); });
    }
    const double scale = scale_W_m2_sr(T_K);
    return {sum.radiance * scale, sum.per_K * scale / T_K};
}

}  // namespace

double planck_radiance(double lambda_um, double T_K) noexcept {
    if (std::isnan(T_K)) return kNaN;
    if (T_K <= 0.0) return 0.0;
    const double l2 = lambda_um * lambda_um;
    return kC1L_W_um4_m2_sr / (l2 * l2 * lambda_um * std::expm1(kC2_um_K / (lambda_um * T_K)));
}

double brightness_temperature(double lambda_um, double radiance) noexcept {
    if (!(radiance > 0.0)) return kNaN;
    const double l2 = lambda_um * lambda_um;
    return kC2_um_K / (lambda_um * std::log1p(kC1L_W_um4_m2_sr / (l2 * l2 * lambda_um * radiance)));
}

double band_radiance(double T_K, double lower_um, double upper_um) {
    if (std::isnan(T_K)) return kNaN;
    if (T_K <= 0.0 || !(upper_um > lower_um)) return 0.0;
    const double a = kC2_um_K / (upper_um * T_K);
    const double b = std::min(lower_um > 0.0 ? kC2_um_K / (lower_um * T_K) : std::numeric_limits<double>::infinity(),
                              a + kTail + 4.0 * std::log1p(a));
    return scale_W_m2_sr(T_K) * integrate(a, b, planck_x);
}

double band_mean_radiance(double T_K, const Spectrum& response) {
    check_response(response, "band response");
    if (std::isnan(T_K)) return kNaN;
    if (T_K <= 0.0) return 0.0;
    return integrate_band(T_K, response).radiance / response_area_um(response);
}

double band_brightness_temperature(double radiance_mean, const Spectrum& response, double near_K) {
    check_response(response, "band response");
    if (!(radiance_mean > 0.0)) return kNaN;
    // ln(band mean) is a convex, falling function of u = 1/T (a sum of log-convex functions is log-convex), so Newton's
    // method in u converges from every start; only a step to u <= 0 has to be shortened.
    const double target = std::log(radiance_mean * response_area_um(response));
    const double middle_um = 0.5 * (response.lambda_um.front() + response.lambda_um.back());
    double u = 1.0 / (near_K > 0.0 ? near_K : brightness_temperature(middle_um, radiance_mean));
    for (int iteration = 0; iteration < 100; ++iteration) {
        const double T_K = 1.0 / u;
        const auto band = integrate_band(T_K, response);
        if (!(band.radiance > 0.0)) {  // colder than a double can tell: towards hotter
            u *= 0.5;
            continue;
        }
        const double slope = -band.per_K / band.radiance * T_K * T_K;
        const double next = u - (std::log(band.radiance) - target) / slope;
        const double change = next - u;
        u = next > 0.0 ? next : 0.5 * u;
        if (std::abs(change) < 1e-7 * u) break;  // what is left is of the order of its square
    }
    return 1.0 / u;
}

}  // namespace pyroscene::radiometry
