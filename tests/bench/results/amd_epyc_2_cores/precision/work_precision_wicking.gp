set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_wicking.png'
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
0.3058 0.0205049
EOD
$published_0_0 << EOD
27.3 0.0339116
25.54 0.0447335
36.5 0.021634
24.57 0.0223755
EOD
$all_0_0 << EOD
27.3 0.0339116
15.25 0.0338892
4.006 0.0283918
1.668 0.0229442
0.3058 0.0205049
25.54 0.0447335
13.6 0.0447479
2.304 0.0448393
0.9585 0.0447918
0.4299 0.0571366
36.5 0.021634
9.941 0.0216332
3.696 0.0215912
1.501 0.0211807
0.3749 0.0239303
24.57 0.0223755
10.29 0.0220307
2.714 0.0228239
1.163 0.0252591
0.3823 0.0230293
EOD
$best_0_0 << EOD
0.3058 0.0205049
EOD
set title 'Wicking in a yarn' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title '-' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
