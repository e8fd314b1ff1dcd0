// A file that tests/check_parameters must find fault with: six numbers are two corners, and seven are too many.
double volume(double x, double y, double z, double toX, double toY, double toZ, double scale = 1.0);
template <class F>
void forEach(int from, int to, F&& f);
inline const auto tilted = [](double, double, double, double, double, double, const double& angle) { return angle; };
