set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'numerical_viscosity.png'
set border 3 lw 1
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set logscale xy
set format '10^{%T}'
set bmargin 9
set key at screen 0.5,0.03 center bottom vertical maxrows 5 samplen 2.5 font ',9'
set xlabel 'time step [s]'
set ylabel '|numerical viscosity| [cm^2/s]'
set title 'Taylor-Green vortex, 16 cells' noenhanced
$curve_0 << EOD
0.0245437 0.392083
0.0490874 0.19353
0.0981748 0.0967581
0.19635 0.0528682
0.392699 0.0385487
EOD
$curve_1 << EOD
0.0245437 0.392831
0.0490874 0.195921
0.0981748 0.0973617
0.19635 0.0476633
0.392699 0.0242217
EOD
$curve_2 << EOD
0.0245437 0.00265069
0.0490874 0.00487612
0.0981748 0.00828133
0.19635 0.0132586
0.392699 0.0197926
EOD
$curve_3 << EOD
0.0245437 0.000263111
0.0490874 0.000670034
0.0981748 0.00114131
0.19635 0.00188613
0.392699 0.00345606
EOD
$curve_4 << EOD
0.0245437 0.00514401
0.0490874 0.00578052
0.0981748 0.00837773
0.19635 0.0128614
0.392699 0.0192074
EOD
$curve_5 << EOD
0.0245437 0.00280437
0.0490874 0.00146825
0.0981748 0.000883053
0.19635 0.000885079
0.392699 0.00154406
EOD
$curve_6 << EOD
0.0245437 0.00271015
0.0490874 0.00461105
0.0981748 0.00782165
0.19635 0.012589
0.392699 0.0190461
EOD
$curve_7 << EOD
0.0245437 0.000138723
0.0490874 0.000135501
0.0981748 0.000215296
0.19635 0.000565388
0.392699 0.00139344
EOD
$curve_8 << EOD
0.0245437 0.00251535
0.0490874 0.00448746
0.0981748 0.00767633
0.19635 0.0123234
0.392699 0.0186396
EOD
$curve_9 << EOD
0.0245437 0.000189388
0.0490874 0.000228442
0.0981748 0.000317944
0.19635 0.000561846
0.392699 0.00140849
EOD
$curve_10 << EOD
0.0245437 0.00250488
0.0490874 0.00448237
0.0981748 0.00767282
0.19635 0.0123188
0.392699 0.0186351
EOD
$curve_11 << EOD
0.0245437 0.000179983
0.0490874 0.000225102
0.0981748 0.000316548
0.19635 0.000565381
0.392699 0.00141532
EOD
plot $curve_0 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#000000' dt (9,5) title 'PIC, plain' noenhanced, \
  $curve_1 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#000000' dt 1 title 'PIC, reflected' noenhanced, \
  $curve_2 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#d55e00' dt (9,5) title 'FLIP, plain' noenhanced, \
  $curve_3 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#d55e00' dt 1 title 'FLIP, reflected' noenhanced, \
  $curve_4 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#0072b2' dt (9,5) title 'APIC, plain' noenhanced, \
  $curve_5 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#0072b2' dt 1 title 'APIC, reflected' noenhanced, \
  $curve_6 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#009e73' dt (9,5) title 'PolyPIC-8, plain' noenhanced, \
  $curve_7 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#009e73' dt 1 title 'PolyPIC-8, reflected' noenhanced, \
  $curve_8 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#cc79a7' dt (9,5) title 'PolyPIC-11, plain' noenhanced, \
  $curve_9 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#cc79a7' dt 1 title 'PolyPIC-11, reflected' noenhanced, \
  $curve_10 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#e69f00' dt (9,5) title 'PolyPIC-27, plain' noenhanced, \
  $curve_11 with linespoints pt 7 ps 0.7 lw 1.6 lc rgb '#e69f00' dt 1 title 'PolyPIC-27, reflected' noenhanced
