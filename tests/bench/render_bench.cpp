// Times one picture of a made-up dam break: render_bench [spacing width height samples repeats file.png]

#include "render/camera.h"
#include "render/renderer.h"
#include "tests/render/fake_dam_break.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

double wallSeconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuSeconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv)
{
    const auto argument = [&](int i, double standard) { return argc > i ? std::atof(argv[i]) : standard; };
    const FakeDamBreak scene(static_cast<float>(argument(1, 0.0945)));
    render::Look look;
    look.width = static_cast<int>(argument(2, 1280));
    look.height = static_cast<int>(argument(3, 720));
    look.samples = static_cast<int>(argument(4, 4));
    look.overlay.label = "PolyPIC (8 modes)";
    const int repeats = static_cast<int>(argument(5, 5));

    const auto context = render::makeOsMesaContext();
    render::Renderer renderer(*context);
    const render::FrameView view = scene.view();
    const render::Camera camera = render::frameBox(render::bounds(view), static_cast<double>(look.width) / look.height,
                                                   render::orbitCamera(Eigen::Vector3d::Zero(), 1.0, 18.0, 14.0));
    std::printf("%s, %zu particles, %d x %d, %d samples\n", context->rendererName().c_str(), scene.positions.size(),
                look.width, look.height, look.samples);
    for (int i = 0; i < repeats; ++i) {
        const double wall0 = wallSeconds(), cpu0 = cpuSeconds();
        const render::Image image = renderer.draw(view, camera, look);
        const double wall1 = wallSeconds(), cpu1 = cpuSeconds();
        render::writePng(image, argc > 6 ? argv[6] : "render_bench.png");
        std::printf("draw %.0f ms (cpu %.0f ms), png %.0f ms\n", 1e3 * (wall1 - wall0), 1e3 * (cpu1 - cpu0),
                    1e3 * (wallSeconds() - wall1));
    }
    return 0;
}
