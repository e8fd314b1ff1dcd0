// Times one picture of something made up: render_bench [dam_break|sheet|weave|drape width height samples repeats file.png spacing]

#include "render/camera.h"
#include "render/renderer.h"
#include "tests/render/fake_dam_break.h"
#include "tests/render/fake_fabric.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace {

double wallSeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void timePictures(const render::FrameView& view, const render::Look& look, double elevation, int repeats, const char* file)
{
    const auto context = render::makeOsMesaContext();
    render::Renderer renderer(*context);
    const render::Camera camera = render::frameBox(render::bounds(view), static_cast<double>(look.width) / look.height,
                                                   render::orbitCamera(Eigen::Vector3d::Zero(), 1.0, 18.0, elevation));
    std::printf("%s, %zu particles, %zu vertices of yarns, %zu of cloth, %d x %d, %d samples\n", context->rendererName().c_str(),
                view.liquid.positions.size(), view.yarns.positions.size(), view.cloth.positions.size(), look.width, look.height, look.samples);
    for (int i = 0; i < repeats; ++i) {
        const double wall0 = wallSeconds(), cpu0 = cpuSeconds();
        const render::Image image = renderer.draw(view, camera, look);
        const double wall1 = wallSeconds(), cpu1 = cpuSeconds();
        render::writePng(image, file);
        std::printf("draw %.0f ms (cpu %.0f ms), png %.0f ms\n", 1e3 * (wall1 - wall0), 1e3 * (cpu1 - cpu0), 1e3 * (wallSeconds() - wall1));
    }
}

}  // namespace

int main(int argc, char** argv)
{
    const auto argument = [&](int i, double standard) { return argc > i ? std::atof(argv[i]) : standard; };
    const std::string name = argc > 1 ? argv[1] : "dam_break";
    render::Look look;
    look.width = static_cast<int>(argument(2, 1280));
    look.height = static_cast<int>(argument(3, 720));
    look.samples = static_cast<int>(argument(4, 4));
    const int repeats = static_cast<int>(argument(5, 5));
    const char* file = argc > 6 ? argv[6] : "render_bench.png";
    if (name == "dam_break") {
        const FakeDamBreak scene(static_cast<float>(argument(7, 0.0945)));
        look.overlay.label = "PolyPIC (8 modes)";
        timePictures(scene.view(), look, 14.0, repeats, file);
        return 0;
    }
    look.obstacles.style = render::ObstacleStyle::Solid;
    look.overlay.liquidBar = false;
    if (name == "sheet") timePictures(FakeSheet(100).view(), look, 32.0, repeats, file);
    else if (name == "weave") timePictures(FakeSheet(16).view(), look, 40.0, repeats, file);
    else timePictures(FakeDrape(120).view(), look, 24.0, repeats, file);
    return 0;
}
