set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_wet_pendulum.png'
set border 3 lw 1
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set logscale xy
set format '10^{%T}'
set bmargin 9
set key at screen 0.5,0.03 center bottom vertical maxrows 5 samplen 2.5 font ',9'
set xlabel 'run time [s]'
set ylabel 'relative error'
$front_0_0 << EOD
0.1237 0.0486079
0.1836 0.0454277
0.3199 0.0288047
0.598 0.015085
1.141 0.00948412
2.22 0.00572043
EOD
$published_0_0 << EOD
0.6062 0.0245434
0.4663 0.0620988
EOD
$all_0_0 << EOD
2.243 0.00601589
1.141 0.00948412
0.598 0.015085
0.3199 0.0288047
0.1836 0.0454277
1.561 0.0637702
0.8087 0.062164
0.4066 0.0589827
0.209 0.0524135
0.1237 0.0486079
EOD
$all_0_1 << EOD
2.22 0.00572043
1.255 0.01169
0.6062 0.0245434
0.3123 0.04857
0.1731 0.0823627
1.537 0.0635985
0.8025 0.0624875
0.4663 0.0620988
0.2321 0.0671839
0.1443 0.0883912
EOD
$all_0_2 << EOD
2.865 0.0559141
1.52 0.057679
0.7874 0.0618753
0.4764 0.0757797
0.4209 0.0821191
2.008 0.0892065
1.085 0.0894429
0.5722 0.0890793
0.3184 0.0975182
0.2535 0.113395
EOD
$best_0_0 << EOD
0.1237 0.0486079
0.1836 0.0454277
0.3199 0.0288047
0.598 0.015085
1.141 0.00948412
2.243 0.00601589
EOD
$best_0_1 << EOD
0.1443 0.0883912
0.1731 0.0823627
0.2321 0.0671839
0.3123 0.04857
0.6062 0.0245434
1.255 0.01169
2.22 0.00572043
EOD
$best_0_2 << EOD
0.2535 0.113395
0.3184 0.0975182
0.4209 0.0821191
0.4764 0.0757797
0.7874 0.0618753
1.52 0.057679
2.865 0.0559141
EOD
set title 'Wet pendulum' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
