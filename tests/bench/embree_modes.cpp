#include "tests/bench/embree_scene.h"
#include "tests/bench/modes.h"

#ifndef RAYPICK_HAS_EMBREE

namespace raypick::bench {

std::vector<Mode> embree_modes(std::shared_ptr<const EmbreeScene>, const RayList&) {
    return {};
}

}  // namespace raypick::bench

#else

#include "tests/bench/flush_denormals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick::bench {

namespace {

constexpr std::size_t kStream = 256;

RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

// Embree's types and calls by the width of a packet.
template <std::size_t N>
struct Packet;
template <>
struct Packet<8> {
    using Rays = RTCRay8;
    using RayHits = RTCRayHit8;
    static constexpr auto kIntersect = rtcIntersect8;
    static constexpr auto kOccluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using Rays = RTCRay16;
    using RayHits = RTCRayHit16;
    static constexpr auto kIntersect = rtcIntersect16;
    static constexpr auto kOccluded = rtcOccluded16;
};

template <class Rays>
void put(Rays& rays, std::size_t lane, const Ray& ray) {
    rays.org_x[lane] = ray.origin.x;
    rays.org_y[lane] = ray.origin.y;
    rays.org_z[lane] = ray.origin.z;
    rays.dir_x[lane] = ray.direction.x;
    rays.dir_y[lane] = ray.direction.y;
    rays.dir_z[lane] = ray.direction.z;
    rays.tnear[lane] = ray.t_min;
    rays.tfar[lane] = ray.t_max;
    rays.mask[lane] = 0xffffffffu;
}

// All rays laid out as packets want them, before the clock runs. The last one is filled up.
template <std::size_t N>
std::vector<typename Packet<N>::Rays> in_packets(std::span<const Ray> rays) {
    std::vector<typename Packet<N>::Rays> packets((rays.size() + N - 1) / N);
    for (std::size_t i = 0; i < packets.size() * N; ++i)
        put(packets[i / N], i % N, rays[std::min(i, rays.size() - 1)]);
    return packets;
}

// Lanes that stand for a ray are -1.
template <std::size_t N>
void choose_lanes(std::array<int, N>& lanes, std::size_t count) {
    for (std::size_t i = 0; i < N; ++i)
        lanes[i] = i < count ? -1 : 0;
}

template <std::size_t N>
Tally closest_packet(RTCScene scene, RTCIntersectContext& context,
                     const typename Packet<N>::Rays& rays, std::size_t count) {
    alignas(64) std::array<int, N> lanes;
    choose_lanes<N>(lanes, count);
    typename Packet<N>::RayHits query;
    query.ray = rays;
    std::fill_n(query.hit.geomID, N, RTC_INVALID_GEOMETRY_ID);
    Packet<N>::kIntersect(lanes.data(), scene, &context, &query);
    Tally sum;
    for (std::size_t i = 0; i < count; ++i) {
        if (query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
            sum += {1, static_cast<double>(query.ray.tfar[i])};
    }
    return sum;
}

// A blocked ray's tfar is minus infinity.
template <std::size_t N>
Tally any_packet(RTCScene scene, RTCIntersectContext& context, const typename Packet<N>::Rays& rays,
                 std::size_t count) {
    alignas(64) std::array<int, N> lanes;
    choose_lanes<N>(lanes, count);
    typename Packet<N>::Rays query = rays;
    Packet<N>::kOccluded(lanes.data(), scene, &context, &query);
    Tally sum;
    for (std::size_t i = 0; i < count; ++i)
        sum.hits += query.tfar[i] < 0.0f ? 1 : 0;
    return sum;
}

template <std::size_t N>
Mode packets(std::shared_ptr<const EmbreeScene> scene, const RayList& list) {
    const auto rays =
        std::make_shared<const std::vector<typename Packet<N>::Rays>>(in_packets<N>(list.rays));
    const auto trace = list.any_hit ? any_packet<N> : closest_packet<N>;
    return {fmt::format("Embree packets of {}", N), false,
            [scene, rays, trace](std::size_t, std::size_t begin, std::size_t end) {
                const FlushDenormals mode;
                auto context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
                Tally sum;
                for (std::size_t i = begin; i < end; i += N)
                    sum += trace(scene->handle(), context, (*rays)[i / N], std::min(N, end - i));
                return sum;
            }};
}

Tally closest_one_by_one(RTCScene scene, std::span<const Ray> rays) {
    auto context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    Tally sum;
    for (const Ray& ray : rays) {
        RTCRayHit query;
        query.ray = embree_ray(ray);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID)
            sum += {1, static_cast<double>(query.ray.tfar)};
    }
    return sum;
}

Tally any_one_by_one(RTCScene scene, std::span<const Ray> rays) {
    auto context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    Tally sum;
    for (const Ray& ray : rays) {
        RTCRay query = embree_ray(ray);
        rtcOccluded1(scene, &context, &query);
        sum.hits += query.tfar < 0.0f ? 1 : 0;
    }
    return sum;
}

Mode single(std::shared_ptr<const EmbreeScene> scene, const RayList& list) {
    const auto trace = list.any_hit ? any_one_by_one : closest_one_by_one;
    return {"Embree single", false,
            [scene, list, trace](std::size_t, std::size_t begin, std::size_t end) {
                const FlushDenormals mode;
                return trace(scene->handle(), list.rays.subspan(begin, end - begin));
            }};
}

Tally closest_stream(RTCScene scene, RTCIntersectContext& context, std::span<const RTCRay> rays) {
    std::array<RTCRayHit, kStream> queries;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        queries[i].ray = rays[i];
        queries[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene, &context, queries.data(), static_cast<unsigned>(rays.size()),
                   sizeof(RTCRayHit));
    Tally sum;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (queries[i].hit.geomID != RTC_INVALID_GEOMETRY_ID)
            sum += {1, static_cast<double>(queries[i].ray.tfar)};
    }
    return sum;
}

Tally any_stream(RTCScene scene, RTCIntersectContext& context, std::span<const RTCRay> rays) {
    std::array<RTCRay, kStream> queries;
    std::copy(rays.begin(), rays.end(), queries.begin());
    rtcOccluded1M(scene, &context, queries.data(), static_cast<unsigned>(rays.size()),
                  sizeof(RTCRay));
    Tally sum;
    for (std::size_t i = 0; i < rays.size(); ++i)
        sum.hits += queries[i].tfar < 0.0f ? 1 : 0;
    return sum;
}

Mode streams(std::shared_ptr<const EmbreeScene> scene, const RayList& list) {
    const auto rays = std::make_shared<std::vector<RTCRay>>();
    rays->reserve(list.rays.size());
    for (const Ray& ray : list.rays)
        rays->push_back(embree_ray(ray));
    const auto trace = list.any_hit ? any_stream : closest_stream;
    return {fmt::format("Embree streams of {}", kStream), false,
            [scene, rays, trace](std::size_t, std::size_t begin, std::size_t end) {
                const FlushDenormals mode;
                auto context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
                Tally sum;
                for (std::size_t i = begin; i < end; i += kStream) {
                    const std::size_t count = std::min(kStream, end - i);
                    sum += trace(scene->handle(), context, std::span(*rays).subspan(i, count));
                }
                return sum;
            }};
}

}  // namespace

std::vector<Mode> embree_modes(std::shared_ptr<const EmbreeScene> scene, const RayList& list) {
    std::vector<Mode> modes{single(scene, list)};
    if (!list.coherent) return modes;
    modes.push_back(packets<8>(scene, list));
    modes.push_back(packets<16>(scene, list));
    modes.push_back(streams(scene, list));
    return modes;
}

}  // namespace raypick::bench

#endif
