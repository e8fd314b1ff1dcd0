set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_splash_cloth_half.png'
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
3.598 0.049271
5.338 0.0274708
5.437 0.0273509
EOD
$published_0_0 << EOD
4.919 0.0678643
EOD
$all_0_0 << EOD
5.338 0.0274708
4.594 0.0540769
5.142 0.0701631
25.05 0.25507
EOD
$all_0_1 << EOD
5.437 0.0273509
3.598 0.049271
4.919 0.0678643
27.44 0.234085
EOD
$best_0_0 << EOD
4.594 0.0540769
5.338 0.0274708
EOD
$best_0_1 << EOD
3.598 0.049271
5.437 0.0273509
EOD
set title 'Water ball on cotton (half)' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
