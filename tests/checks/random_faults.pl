#!/usr/bin/perl
# How many faults do the tests notice?  Draws faults at random lines of the
# rooms, builds the program with each one and runs the suites until one fails.
#
#   make random-faults ARGS='SEED COUNT [ROOM...]'
#
# One seed draws the same faults as long as the sources stay.  A fault that the
# compiler notices, or that leaves the same machine code, is drawn again.  The suites
# nearest to the fault run first, then the quicker ones.  Survivors need a
# reader: some of them change nothing that anybody could notice.
use strict;
use warnings;
use Cwd 'abs_path';
use List::Util 'max';
use Time::HiRes 'time';

my ($seed, $count, @rooms) = @ARGV;
die "make random-faults ARGS='SEED COUNT [ROOM...]'\n" unless $count;
@rooms = qw(base model solve step scenes picture play) unless @rooms;
delete @ENV{qw(MAKEFLAGS MFLAGS MAKELEVEL)};
my $checks = '(files|homework|lecture|lines|log|pages|scripts|tables|faults|window)';
my %near = (
    base => 'base|terms|tables', model => 'terms|laws|mesh|reference|tables',
    solve => 'newton|multigrid|reference|widths|terms|stress',
    step => 'laws|reference|pure|player', lecture => 'lecture|reference',
    scenes => 'scenes|options|mesh|past|tables|numbers',
    picture => 'layout|show|picture|numbers|session',
    play => 'past|player|session|film|scripts');

# ---- where faults can stand --------------------------------------------------
sub read_file {
    open(my $file, '<', $_[0]) or die "$_[0]: $!\n";
    local $/;
    return scalar <$file>;
}

sub write_file {
    my ($name, $text) = @_;
    my @times = (stat $name)[8, 9]; # make shall not write the listings anew
    open(my $file, '>', $name) or die "$name: $!\n";
    print $file $text;
    close($file) or die "$name: $!\n";
    utime @times, $name;
}

# Comments and strings as blanks of the same length.
sub mask {
    my ($text) = @_;
    $text =~ s{(/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')}
              {my ($part, $blank) = ($1, substr($1, 0, 1) eq '/' ? ' ' : "\x01");
               $part =~ s/[^\n]/$blank/gr}gse;
    return $text;
}

my %other = ('<' => '<=', '<=' => '<', '>' => '>=', '>=' => '>', '==' => '!=',
             '!=' => '==', '&&' => '||', '||' => '&&', '+' => '-', '-' => '+',
             '+=' => '-=', '-=' => '+=');
my $simple = qr/[\w.\[\]&*]+(?:->[\w.\[\]]+)*/;

# The faults that a masked line can have: kind, column, length, new text.
sub faults_of {
    my ($line, $whole) = @_;
    my @found;
    my $add = sub { push @found, [$_[0], $-[$_[1]], $+[$_[1]] - $-[$_[1]], $_[2]] };
    my $declares = $line =~ /^\s+(?:static |const |struct |unsigned )*\w+ \**\w+(?:\[[^\]]*\])+(?:[;,]| =)/;
    $add->('sign', 1, $other{$1}) while $line =~ /(?<=[\w)\]]) ([-+]=?) (?=[\w(&*])/g;
    $add->('sign', 1, '') while $line =~ /(?:[=(,?:*\/] ?|return )(-)(?=[A-Za-z_(])/g;
    $add->('compare', 1, $other{$1}) while $line =~ / (<=?|>=?|==|!=|&&|\|\|)(?: |$)/g;
    while (!$declares && $line =~ /(?<=[\w\])])\[([^\[\]]+)\]/g) {
        $add->('index', 1, $1 eq '0' ? 1 : $1 =~ /^(.*) [-+] 1$/ ? $1 : "$1 + 1");
    }
    while ($line =~ /[(,] ?($simple, $simple)(?=[,)])/g) {
        my ($first, $second) = split /, /, $1;
        $add->('order', 1, "$second, $first") unless $first eq $second;
        pos($line) = $+[1] - length $second;
    }
    $add->('constant', 1, $1 eq '0' ? 1 : $1 eq '1' ? 2 : "($1 * 1.5)")
        while !$declares && $line =~ /(?<![\w.'])(\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.])/g;
    if ($whole && $line =~ /^\s++((?!return|break|continue|goto|case|default|static|const|else)[^;{}]+;)\s*$/
        && $line !~ /^\s++(?:unsigned |struct )?\w+ \**\w+(?:\[.*\])?(?:;| = |, )/) {
        my $statement = $1;
        my $kind = $statement =~ / = (?:0|false|NULL|-1);|^memset/ ? 'reset' : 'dropped';
        $line =~ /(\S.*;)/;
        $add->($kind, 1, ';');
    }
    return @found;
}

# Lines that can have a fault: file, number, begin in the text, faults.
my (@lines, %text);
for my $file (map { $_ eq 'lecture' ? 'src/lecture.c' : sort glob("src/$_/*.c") } @rooms) {
    next if $file =~ /_web\.c$/;
    my $masked = mask($text{$file} = read_file($file));
    my ($number, $at, $inside, $before) = (0, 0, 0, '');
    for my $line (split /\n/, $masked) {
        $number++;
        $inside = 1 if $line =~ /^(\{|.*= \{$)/;
        my @faults = $inside && $line =~ /^ {4}/
            ? faults_of($line, $before =~ /[;{})]\s*$|^\s*$|:\s*$/) : ();
        push @lines, [$file, $number, $at, \@faults] if @faults;
        $inside = 0 if $line =~ /^\}/;
        $before = $line if $line =~ /\S/;
        $at += length($line) + 1;
    }
}

# ---- one fault after the other ------------------------------------------------
my $tree = abs_path('.') . "/build/random.$$";
mkdir $tree or die "$tree: $!\n";
END { system('rm', '-rf', $tree) if $tree }
$SIG{INT} = $SIG{TERM} = $SIG{HUP} = sub { exit 1 };
setpriority(0, 0, 15);
system("mkdir $tree/build; cp -pR Makefile README.md include src tests $tree && " .
       "cp -pR build/*.mk build/release $tree/build") == 0 or die;
chdir $tree or die;
system('make -s all suites') == 0 or die "it does not build\n";

# Whether a suite or check passes within so much processor time, s; it may
# wait for windows ten times as long.
sub passes {
    my ($suite, $limit) = @_;
    my $run = $suite =~ /\.sh$/ ? "sh tests/checks/$suite"
                                : "build/release/tests/unit/$suite";
    return system("ulimit -S -t $limit; ulimit -c 0; CMOCKA_TEST_ABORT=1 " .
        "exec timeout -k 5 " . 10 * $limit . " $run >log 2>&1 </dev/null") == 0;
}

my %time; # of each suite, s, where all is right
for my $suite ((map { m{([^/]+)\.c$} } glob 'tests/unit/test_*.c'),
               (map { "check_$_.sh" } grep /^$checks$/, map { m{check_(.*)\.sh} }
                    glob 'tests/checks/check_*.sh')) {
    my $start = time;
    passes($suite, 60) or passes($suite, 60) or die "$suite fails without a fault\n", `tail -n 20 log`;
    $time{$suite} = time - $start;
}

# The first suite that fails, or nothing.
sub killer {
    my ($room) = @_;
    my @first = grep /^(test|check)_($near{$room})\b/, keys %time;
    my @rest = grep !/^(test|check)_($near{$room})\b/, keys %time;
    for my $part (\@first, \@rest) {
        system('make -s build/elasto build/lecture ' . join(' ', map { "build/release/tests/unit/$_" }
            grep !/\.sh$/, @$part) . ' >log 2>&1') == 0 or return 'make';
        for my $suite (sort { $time{$a} <=> $time{$b} } @$part) {
            my $limit = int(10 + 3 * $time{$suite});
            passes($suite, $limit) || ($suite =~ /\.sh$/ && passes($suite, $limit)) || return $suite;
        }
    }
    return '';
}

srand($seed);
my (%drawn, %killed, @survivors);
for (my $made = 0; $made < $count;) {
    my ($file, $number, $at, $faults) = @{ $lines[rand @lines] };
    my ($kind, $column, $length, $new) = @{ $faults->[rand @$faults] };
    my $old = substr($text{$file}, $at + $column, $length);
    my $wrong = $text{$file};
    substr($wrong, $at + $column, $length) = $new;
    my $object = $file =~ s{^src/(.*)\.c$}{build/release/$1.o}r;
    rename $object, 'object' or die "$object: $!\n";
    my $again = $object =~ s{/\w+/(?=\w+\.o)}{/narrow/}r; # test_widths compiles it twice
    write_file($file, $wrong);
    unlink $again;
    my $fault = system("make -s $object >log 2>&1") == 0 &&
        read_file('log') !~ /warning:/ &&
        system("strip -g -o a object && strip -g -o b $object && cmp -s a b") != 0;
    if ($fault) {
        my $room = $file =~ m{src/(\w+)/} ? $1 : 'lecture';
        my $killer = killer($room);
        $made++;
        $drawn{$room}++;
        $killed{$room}++ if $killer;
        my $line = "$file:$number $kind: $old -> $new";
        push @survivors, $line unless $killer;
        printf "%s %s\n", $killer ? "killed by $killer:" : 'SURVIVED', $line;
        $| = 1;
    }
    write_file($file, $text{$file});
    rename 'object', $object;
    unlink $again, 'build/release/libelasto.a', 'build/release/lecture';
}
for my $room (grep { $drawn{$_} } @rooms) {
    printf "%-8s %3d of %3d, %3.0f %%\n", $room, $killed{$room} // 0, $drawn{$room},
        100 * ($killed{$room} // 0) / $drawn{$room};
}
printf "all      %3d of %3d, %3.0f %%, seed %d\n", $count - @survivors, $count,
    100 * ($count - @survivors) / $count, $seed;
print map { "survived: $_\n" } @survivors;
